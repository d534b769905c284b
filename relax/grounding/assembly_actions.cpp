#include <algorithm>
#include <cassert>

#include "assembly.hpp"

namespace relax::grounding {

namespace {

bool contains(const Conjunction& sorted, Literal literal) {
    assert(std::ranges::is_sorted(sorted));
    return std::ranges::binary_search(sorted, literal);
}

// The literals of a condition that are not always true.
Conjunction without_constants(const Remains& remains, std::span<const Literal> condition) {
    Conjunction rest;
    for (const Literal literal : condition) {
        if (remains.is_literal_reached[negation(literal)]) {
            rest.push_back(literal);
        }
    }
    return rest;
}

// What is left of a condition where the action's precondition holds; nothing if
// it cannot hold then.
std::optional<Conjunction> condition_within(const Remains& remains, std::span<const Literal> condition,
                                            const Conjunction& precondition) {
    Conjunction rest;
    for (const Literal literal : condition) {
        if (!remains.is_literal_reached[literal] || contains(precondition, negation(literal))) {
            return std::nullopt;
        }
        if (remains.is_literal_reached[negation(literal)] && !contains(precondition, literal)) {
            rest.push_back(literal);
        }
    }
    return rest;
}

RemainingBranch& branch_of(RemainingCase& one, BranchId branch) {
    const auto at = std::ranges::lower_bound(one.branches, branch, {}, &RemainingBranch::id);
    return at != one.branches.end() && at->id == branch ? *at : *one.branches.insert(at, {branch, {}, {}});
}

// Put what the action changes and costs where the precondition holds into the case, each to its branch.
void add_effects(const Remains& remains, RemainingCase& one) {
    const Cases& cases = remains.cases;
    for (const EffectId effect : cases.effects[cases.owner[one.number]]) {
        const auto condition = condition_within(remains, cases.effect_condition[effect], one.condition);
        if (cases.is_effect_alive[effect] && condition) {
            const BranchId branch = cases.effect_branch[effect];
            Effects& effects = branch == Cases::kCertain ? one.effects : branch_of(one, branch).effects;
            std::ranges::copy(cases.effect_changes[effect], std::back_inserter(effects[*condition]));
        }
    }
}

void add_costs(const Remains& remains, RemainingCase& one) {
    const Cases& cases = remains.cases;
    for (const CostPartId part : cases.cost_parts[cases.owner[one.number]]) {
        Disjunction condition;
        for (const AlternativeId alternative : cases.cost_alternatives[part]) {
            if (auto rest = condition_within(remains, cases.cost_condition[alternative], one.condition)) {
                condition.push_back(*std::move(rest));
            }
        }
        drop_subsumed(condition);
        if (!condition.empty()) {
            const BranchId branch = cases.cost_branch[part];
            Costs& costs = branch == Cases::kCertain ? one.costs : branch_of(one, branch).costs;
            std::ranges::copy(cases.cost_blocks[part], std::back_inserter(costs[condition]));
        }
    }
}

}  // namespace

// Drop effects that the precondition or other effects make redundant.
void tidy(Effects& effects, const Conjunction& precondition) {
    const auto always = effects.find({});
    const Conjunction unconditional = always == effects.end() ? Conjunction{} : always->second;
    std::vector<Literal> made;
    for (const auto& [condition, changes] : effects) {
        made.insert(made.end(), changes.begin(), changes.end());
    }
    std::ranges::sort(made);
    const auto changes_nothing = [&](Literal change, bool is_conditional) {
        const Literal added = literal_of(fact_of(change));
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
            return changes_nothing(change, !condition.empty()) ||
                   (is_negated(change) && contains(before, negation(change)));
        });
    }
    std::erase_if(effects, [](const auto& effect) { return effect.second.empty(); });
}

std::vector<RemainingCase> remaining_cases(const Remains& remains, NodeId action) {
    constexpr std::size_t kMostComparedCases = 300;
    std::vector<RemainingCase> candidates;
    for (const CaseId number : remains.cases.cases[action]) {
        if (remains.cases.is_alive[number]) {
            candidates.push_back({number, without_constants(remains, remains.cases.condition[number]), {}, {}, {}});
        }
    }
    std::ranges::stable_sort(candidates, {}, [](const RemainingCase& one) { return one.condition.size(); });
    std::vector<RemainingCase> kept;
    for (RemainingCase& candidate : candidates) {
        const auto covers = [&](const RemainingCase& other) {
            return std::ranges::includes(candidate.condition, other.condition);
        };
        if (kept.size() > kMostComparedCases || std::ranges::none_of(kept, covers)) {
            add_effects(remains, candidate);
            add_costs(remains, candidate);
            if (candidate.branches.empty()) {
                tidy(candidate.effects, candidate.condition);
            }
            kept.push_back(std::move(candidate));
        }
    }
    return kept;
}

std::vector<bool> read_facts(const Remains& remains, const std::vector<bool>& is_written) {
    std::vector<bool> is_read(remains.is_initially_true.size(), false);
    const auto read = [&](std::span<const Literal> condition) {
        bool is_new = false;
        for (const Literal literal : condition) {
            is_new = is_new || !is_read[fact_of(literal)];
            is_read[fact_of(literal)] = true;
        }
        return is_new;
    };
    Rows<Literal> conditions;  // of effects that have one
    Rows<Literal> changes_under;
    const auto read_parts = [&](const Effects& effects, const Costs& costs) {
        for (const auto& [condition, blocks] : costs) {
            std::ranges::for_each(condition, read);
        }
        for (const auto& [condition, changes] : effects) {
            if (!condition.empty()) {
                conditions.add_row(condition);
                changes_under.add_row(changes);
            }
        }
    };
    for (NodeId node = 0; node < is_written.size(); ++node) {
        if (!is_written[node]) {
            continue;
        }
        remains.limits.stop_if_reached();
        for (const RemainingCase& one : remaining_cases(remains, node)) {
            read(one.condition);
            read_parts(one.effects, one.costs);
            for (const RemainingBranch& branch : one.branches) {
                read_parts(branch.effects, branch.costs);
            }
        }
    }
    // Facts that only effects on unread facts have in their conditions are not read, either.
    const auto matters = [&](Literal change) { return is_read[fact_of(change)]; };
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t effect = 0; effect < conditions.size(); ++effect) {
            remains.limits.stop_if_reached();
            changed = (std::ranges::any_of(changes_under[effect], matters) && read(conditions[effect])) || changed;
        }
    }
    return is_read;
}

}  // namespace relax::grounding
