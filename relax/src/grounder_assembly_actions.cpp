#include <algorithm>
#include <map>

#include "grounder_assembly.hpp"

namespace relax::grounding {

namespace {

bool contains(const Conjunction& sorted, Literal literal) { return std::ranges::binary_search(sorted, literal); }

// What is left of an effect's condition where the action's precondition holds;
// nothing if the effect cannot happen.
std::optional<Conjunction> condition_within(const Remains& remains, std::uint32_t effect,
                                            const Conjunction& precondition) {
    Conjunction condition;
    for (const Literal literal : without_constants(remains, remains.cases.effect_condition[effect])) {
        if (contains(precondition, negation(literal))) {
            return std::nullopt;
        }
        if (!contains(precondition, literal)) {
            condition.push_back(literal);
        }
    }
    return condition;
}

using Effects = std::map<Conjunction, Conjunction>;  // changes by condition; the
                                                     // unconditional ones come first

// Drop changes that change nothing.
void tidy(Effects& effects, const Conjunction& precondition) {
    const auto always = effects.find({});
    const Conjunction unconditional = always == effects.end() ? Conjunction{} : always->second;
    std::vector<Literal> made;
    for (const auto& [condition, changes] : effects) {
        made.insert(made.end(), changes.begin(), changes.end());
    }
    std::ranges::sort(made);
    const auto is_void = [&](Literal change, bool is_conditional) {
        const Literal added = 2 * fact_of(change);
        if (is_negated(change) && (contains(precondition, change) || std::ranges::count(unconditional, added) > 0)) {
            return true;
        }
        if (!is_negated(change) && contains(precondition, change) && !contains(made, negation(change))) {
            return true;
        }
        return is_conditional && std::ranges::count(unconditional, change) > 0;
    };
    for (auto& [condition, changes] : effects) {
        std::ranges::sort(changes);
        const auto repeated = std::ranges::unique(changes);
        changes.erase(repeated.begin(), repeated.end());
        const Conjunction before = changes;
        std::erase_if(changes, [&](Literal change) {
            return is_void(change, !condition.empty()) || (is_negated(change) && contains(before, negation(change)));
        });
    }
    std::erase_if(effects, [](const auto& effect) { return effect.second.empty(); });
}

}  // namespace

Conjunction without_constants(const Remains& remains, std::span<const Literal> condition) {
    Conjunction rest;
    for (const Literal literal : condition) {
        if (remains.is_literal_reached[negation(literal)]) {
            rest.push_back(literal);
        }
    }
    return rest;
}

std::vector<RemainingCase> remaining_cases(const Remains& remains, NodeId action) {
    constexpr std::size_t kMostComparedCases = 300;
    std::vector<RemainingCase> candidates;
    for (CaseId number = remains.cases.begin[action]; number < remains.cases.begin[action + 1]; ++number) {
        if (remains.cases.is_alive[number]) {
            candidates.push_back({number, without_constants(remains, remains.cases.condition[number])});
        }
    }
    std::ranges::stable_sort(candidates, {}, [](const RemainingCase& one) { return one.condition.size(); });
    std::vector<RemainingCase> kept;
    for (RemainingCase& candidate : candidates) {
        const auto covers = [&](const RemainingCase& other) {
            return std::ranges::includes(candidate.condition, other.condition) &&
                   std::ranges::equal(remains.cases.cost_parts[candidate.number],
                                      remains.cases.cost_parts[other.number]);
        };
        if (kept.size() > kMostComparedCases || std::ranges::none_of(kept, covers)) {
            kept.push_back(std::move(candidate));
        }
    }
    return kept;
}

std::vector<bool> read_facts(const Remains& remains, const std::vector<std::vector<RemainingCase>>& cases_of_actions) {
    std::vector<bool> is_read(remains.is_initially_true.size(), false);
    for (const std::vector<RemainingCase>& cases : cases_of_actions) {
        for (const RemainingCase& one : cases) {
            for (const Literal literal : one.condition) {
                is_read[fact_of(literal)] = true;
            }
        }
    }
    const Cases& cases = remains.cases;
    for (bool changed = true; changed;) {
        changed = false;
        for (std::uint32_t effect = 0; effect < cases.effect_owner.size(); ++effect) {
            const auto matters = [&](Literal change) { return is_read[fact_of(change)]; };
            if (cases.is_effect_alive[effect] && std::ranges::any_of(cases.effect_changes[effect], matters)) {
                for (const Literal literal : without_constants(remains, cases.effect_condition[effect])) {
                    changed = changed || !is_read[fact_of(literal)];
                    is_read[fact_of(literal)] = true;
                }
            }
        }
    }
    return is_read;
}

void write_action(const Remains& remains, const RemainingCase& one,
                  const std::vector<std::optional<FactId>>& number_of_fact, GroundProblem& problem) {
    const auto number = [&](Literal literal) { return *number_of_fact[fact_of(literal)]; };
    const auto write = [&](const Conjunction& literals, Rows<FactId>& positive, Rows<FactId>& negative) {
        for (const Literal literal : literals) {
            (is_negated(literal) ? negative : positive).push(number(literal));
        }
        positive.finish_row();
        negative.finish_row();
    };
    const NodeId owner = remains.cases.owner[one.number];
    Effects effects;
    for (std::uint32_t effect = remains.cases.effect_begin[owner]; effect < remains.cases.effect_begin[owner + 1];
         ++effect) {
        const auto condition = condition_within(remains, effect, one.condition);
        if (remains.cases.is_effect_alive[effect] && condition) {
            for (const Literal change : remains.cases.effect_changes[effect]) {
                if (number_of_fact[fact_of(change)]) {
                    effects[*condition].push_back(change);
                }
            }
        }
    }
    tidy(effects, one.condition);
    write(one.condition, problem.preconditions, problem.negative_preconditions);
    for (const auto& [condition, changes] : effects) {
        write(condition, problem.effect_conditions, problem.effect_negative_conditions);
        write(changes, problem.effect_adds, problem.effect_deletes);
    }
    problem.effect_begin.push_back(static_cast<EffectId>(problem.effect_adds.size()));
}

}  // namespace relax::grounding
