// How relaxed models settle the parts of an action's cost.

#include "relax/heuristics/relaxed_model.hpp"

namespace relax {

// A part is due by its condition, and not due by the negation.
std::vector<FactId> RelaxedModel::facts_of_priced_parts(const GroundProblem& problem, std::span<const Cost> parts,
                                                        Limits& limits) {
    std::vector<FactId> facts;
    for (const CostPartId part : all_ids<CostPartId>(parts.size())) {
        limits.stop_if_reached();
        for (const AlternativeId alternative : problem.cost_alternatives[part]) {
            for (const auto& row :
                 {problem.cost_conditions[alternative], problem.cost_negative_conditions[alternative]}) {
                facts.insert(facts.end(), row.begin(), parts[part] > 0 ? row.end() : row.begin());
            }
        }
    }
    return facts;
}

// `needed`: what the first part needs; afterwards, what the effects need.
void RelaxedModel::settle_costs(const GroundProblem& problem, ActionId action, std::vector<RelaxedFact>& needed) {
    std::vector<RelaxedFact> asked_for;
    if (is_decomposition()) {
        asked_for.push_back(may_start(action));
    }
    for (const CostPartId part : problem.cost_parts[action]) {
        if (owner_cost[part_owner(part)] == 0) {
            continue;
        }
        const RelaxedFact settled = add_fact();
        const auto alternatives = problem.cost_alternatives[part];
        std::vector<RelaxedFact> not_due = needed;
        for (const AlternativeId alternative : alternatives) {
            std::vector<RelaxedFact> due = needed;
            for (const FactId fact : problem.cost_conditions[alternative]) {
                due.push_back(holds(fact));
            }
            for (const FactId fact : problem.cost_negative_conditions[alternative]) {
                due.push_back(complement_of_[fact]);
            }
            add_operator(std::move(due), {settled}, part_owner(part));
            if (alternatives.size() > 1) {
                not_due.push_back(add_fact());
                add_failures(problem, alternative, asked_for, not_due.back());
            }
        }
        if (alternatives.size() == 1) {
            add_failures(problem, alternatives.front(), needed, settled);
        } else {
            add_operator(std::move(not_due), {settled}, free_owner());
        }
        needed = asked_for;
        needed.push_back(settled);
    }
}

// The ways in which an alternative of a condition does not hold: one of its facts is false, or of those negated true.
void RelaxedModel::add_failures(const GroundProblem& problem, AlternativeId alternative,
                                const std::vector<RelaxedFact>& needed, RelaxedFact made) {
    const auto add = [&](RelaxedFact fails) {
        std::vector<RelaxedFact> all = needed;
        all.push_back(fails);
        add_operator(std::move(all), {made}, free_owner());
    };
    for (const FactId fact : problem.cost_conditions[alternative]) {
        add(complement_of_[fact]);
    }
    for (const FactId fact : problem.cost_negative_conditions[alternative]) {
        add(holds(fact));
    }
}

}  // namespace relax
