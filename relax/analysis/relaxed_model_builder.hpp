#ifndef RELAX_ANALYSIS_RELAXED_MODEL_BUILDER_HPP
#define RELAX_ANALYSIS_RELAXED_MODEL_BUILDER_HPP

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "relax/analysis/relaxed_model.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

template <typename Value>
void sort_unique(std::vector<Value>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

// What the relaxed models have in common: facts about the state, and actions.
class RelaxedModelBuilder {
public:
    // `costs`: of the owners that come before the cost parts. Throws Stopped.
    RelaxedModelBuilder(const GroundProblem& problem, std::span<const Cost> costs, std::span<const Cost> part_prices,
                        Limits& limits);

    // The model so far; `finish` adds what is looked up by fact or owner.
    RelaxedModel model;

    // For every task a fact that it may start, which its actions will need.
    void add_starts();
    RelaxedFact add_fact() { return static_cast<RelaxedFact>(fact_count_++); }
    void add_operator(std::vector<RelaxedFact> needed, std::vector<RelaxedFact> made, OwnerId owner);
    // The operators of an action, and those that settle the parts of its cost.
    void add_action(ActionId action, OwnerId owner);
    RelaxedModel finish(Limits& limits);

    OwnerId free_owner() const { return static_cast<OwnerId>(model.owner_cost.size() - 1); }

private:
    void settle_costs(ActionId action, std::vector<RelaxedFact>& needed);
    void add_failures(AlternativeId alternative, const std::vector<RelaxedFact>& needed, RelaxedFact made);
    OwnerId part_owner(CostPartId part) const { return static_cast<OwnerId>(first_part_ + part); }

    const GroundProblem& problem_;
    std::size_t fact_count_ = 0;
    std::size_t first_part_;                  // its owner
    std::vector<RelaxedFact> complement_of_;  // by FactId; kAlwaysTrue where there is none
};

}  // namespace relax

#endif
