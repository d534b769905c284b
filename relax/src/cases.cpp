#include "cases.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace relax {

namespace {

constexpr std::size_t kMostCases = 10000;

// Thrown while a formula falls into too many cases; `CaseBuilder::build` adds which action it is.
struct CaseLimitPassed {};

void check_count(const Cases& cases) {
    if (cases.size() > kMostCases) {
        throw CaseLimitPassed{};
    }
}

std::optional<Cube> merge(const Cube& left, const Cube& right) {
    Cube both;
    both.reserve(left.size() + right.size());
    std::set_union(left.begin(), left.end(), right.begin(), right.end(), std::back_inserter(both));
    for (std::size_t at = 1; at < both.size(); ++at) {
        if (fact_of(both[at - 1]) == fact_of(both[at])) {
            return std::nullopt;
        }
    }
    return both;
}

// All of the disjunctions at once: single cases first, since they decide others, then the shortest disjunctions.
Cases conjunction_of_all(std::vector<Cases> parts) {
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Cases& left, const Cases& right) { return left.size() < right.size(); });
    Cases result{{}};
    for (const Cases& part : parts) {
        result = conjunction(result, part);
    }
    return result;
}

}  // namespace

void simplify(Cases& cases) {
    std::sort(cases.begin(), cases.end(), [](const Cube& left, const Cube& right) {
        return left.size() != right.size() ? left.size() < right.size() : left < right;
    });
    Cases kept;
    for (Cube& cube : cases) {
        const bool contained = std::any_of(kept.begin(), kept.end(), [&](const Cube& other) {
            return std::includes(cube.begin(), cube.end(), other.begin(), other.end());
        });
        if (!contained) {
            kept.push_back(std::move(cube));
        }
    }
    cases = std::move(kept);
}

Cases conjunction(const Cases& left, const Cases& right) {
    Cases result;
    for (const Cube& first : left) {
        for (const Cube& second : right) {
            if (auto both = merge(first, second)) {
                result.push_back(std::move(*both));
                check_count(result);
            }
        }
    }
    if (result.size() > 1) {
        simplify(result);
    }
    return result;
}

CaseBuilder::CaseBuilder(Reachability& reachability) : reachability_(reachability) {
    FactId begin = 0;
    for (std::uint32_t predicate = 0; predicate < reachability.problem().predicate_count; ++predicate) {
        fact_begin_.push_back(begin);
        if (!reachability.is_static(predicate)) {
            begin += static_cast<FactId>(reachability.facts(predicate).size());
        }
    }
    fact_begin_.push_back(begin);
}

std::uint32_t CaseBuilder::predicate(FactId fact) const {
    const auto after = std::upper_bound(fact_begin_.begin(), fact_begin_.end() - 1, fact);
    return static_cast<std::uint32_t>(after - fact_begin_.begin()) - 1;
}

std::span<const ObjectId> CaseBuilder::arguments(FactId fact) const {
    const std::uint32_t of = predicate(fact);
    return reachability_.facts(of)[fact - fact_begin_[of]];
}

bool CaseBuilder::is_initial(FactId fact) const {
    const std::uint32_t of = predicate(fact);
    return fact - fact_begin_[of] < reachability_.initial_count(of);
}

void CaseBuilder::build(const TaskInstance& instance, std::vector<ActionCase>& cases) {
    const LiftedAction& action = reachability_.problem().actions[instance.task];
    const auto objects = reachability_.instances(instance.task)[instance.tuple];
    Binding binding(objects.begin(), objects.end());
    binding.resize(action.slot_count, kUnbound);
    std::vector<ActionCase> made;
    try {
        for (Cube& cube : cases_of(action.precondition, binding, false)) {
            made.push_back({instance, std::move(cube), {}, {}});
        }
        split_by_cost(action, binding, made);
        const auto all_effects = effects(action, binding);
        for (ActionCase& one : made) {
            one.effects = all_effects;
            cases.push_back(std::move(one));
        }
    } catch (const CaseLimitPassed&) {
        throw TooManyCases{instance};
    }
}

// Split the cases so that each has one cost law: every conditional part of the cost is due in all of a case or in none.
void CaseBuilder::split_by_cost(const LiftedAction& action, Binding& binding, std::vector<ActionCase>& cases) const {
    for (const LiftedCostCondition& part : action.cost_conditions) {
        for_all_objects(part.variables, reachability_.domains(), binding, [&] {
            reachability_.check_limits();
            const Cases due = cases_of(part.condition, binding, false);
            const Cases not_due = cases_of(part.condition, binding, true);
            std::vector<ActionCase> split;
            for (const ActionCase& whole : cases) {
                for (Cube& cube : conjunction({whole.precondition}, due)) {
                    split.push_back({whole.instance, std::move(cube), whole.cost_parts, {}});
                    auto& parts = split.back().cost_parts;
                    parts.push_back(part.block);
                    parts.push_back(static_cast<std::uint32_t>(part.variables.size()));
                    for (const LiftedVariable& variable : part.variables) {
                        parts.push_back(binding[variable.slot]);
                    }
                }
                for (Cube& cube : conjunction({whole.precondition}, not_due)) {
                    split.push_back({whole.instance, std::move(cube), whole.cost_parts, {}});
                }
            }
            cases = std::move(split);
            if (cases.size() > kMostCases) {
                throw CaseLimitPassed{};
            }
            return true;
        });
    }
}

std::vector<ActionCase::Effect> CaseBuilder::effects(const LiftedAction& action, Binding& binding) const {
    std::map<Cube, std::size_t> known;  // the unconditional effect, with the empty condition, comes first
    std::vector<ActionCase::Effect> made;
    std::vector<ObjectId> tuple;
    for (const LiftedEffect& effect : action.effects) {
        for_all_objects(effect.variables, reachability_.domains(), binding, [&] {
            reachability_.check_limits();
            tuple.clear();
            for (const Term term : effect.arguments) {
                tuple.push_back(value_of(term, binding));
            }
            const auto id = reachability_.facts(effect.predicate).find(tuple);
            if (!id) {
                return true;  // deletes what never holds, or adds under a condition that never does
            }
            for (Cube& condition : cases_of(effect.condition, binding, false)) {
                const auto at = known.try_emplace(condition, made.size()).first->second;
                if (at == made.size()) {
                    made.push_back({std::move(condition), {}, {}});
                }
                (effect.positive ? made[at].adds : made[at].deletes).push_back(fact_begin_[effect.predicate] + *id);
            }
            return true;
        });
    }
    return made;
}

Cases CaseBuilder::cases_of(const Formula& formula, Binding& binding, bool negated) const {
    switch (formula.kind) {
        case FormulaKind::Atom:
            return cases_of_atom(formula, binding, negated);
        case FormulaKind::Equals:
        case FormulaKind::InDomain: {
            const ObjectId first = value_of(formula.terms[0], binding);
            const bool holds = formula.kind == FormulaKind::Equals
                                   ? first == value_of(formula.terms[1], binding)
                                   : reachability_.domains().contains(formula.symbol, first);
            return holds != negated ? Cases{{}} : Cases{};
        }
        case FormulaKind::Not:
            return cases_of(formula.operands.front(), binding, !negated);
        default:
            break;
    }
    const bool conjunctive = (formula.kind == FormulaKind::And || formula.kind == FormulaKind::Forall) != negated;
    Cases result;
    std::vector<Cases> parts;  // of a conjunction
    const auto take = [&](const Formula& operand) {
        Cases cases = cases_of(operand, binding, negated);
        if (conjunctive) {
            parts.push_back(std::move(cases));
            return !parts.back().empty();
        }
        std::move(cases.begin(), cases.end(), std::back_inserter(result));
        check_count(result);
        return true;
    };
    if (formula.kind == FormulaKind::And || formula.kind == FormulaKind::Or) {
        std::all_of(formula.operands.begin(), formula.operands.end(), take);
    } else {
        for_all_objects(formula.variables, reachability_.domains(), binding, [&] {
            reachability_.check_limits();
            return take(formula.operands.front());
        });
    }
    if (conjunctive) {
        return conjunction_of_all(std::move(parts));
    }
    simplify(result);
    return result;
}

Cases CaseBuilder::cases_of_atom(const Formula& formula, const Binding& binding, bool negated) const {
    std::vector<ObjectId> tuple;
    for (const Term term : formula.terms) {
        tuple.push_back(value_of(term, binding));
    }
    const auto id = reachability_.facts(formula.symbol).find(tuple);
    if (reachability_.is_static(formula.symbol) || !id) {
        return id.has_value() != negated ? Cases{{}} : Cases{};
    }
    return {{literal(fact_begin_[formula.symbol] + *id, negated)}};
}

}  // namespace relax
