#ifndef RELAX_ANALYSIS_PRICED_PROBLEM_HPP
#define RELAX_ANALYSIS_PRICED_PROBLEM_HPP

#include <cassert>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/analysis/prices.hpp"
#include "relax/analysis/relaxed_model.hpp"
#include "relax/base/cost.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/on_demand.hpp"

namespace relax {

// A problem at one vector of prices, and what follows from these: each thing is made when it is first asked for, once
// for all searches and heuristics that have these prices, also of several threads. What takes limits throws Stopped.
class PricedProblem {
public:
    // The problem must live longer.
    PricedProblem(const AnalysedProblem& problem_at_prices, Prices its_prices)
        : problem(problem_at_prices), prices(std::move(its_prices)) {
        assert(prices.actions.size() == problem.action_count() && prices.parts.size() == problem.cost_part_count());
    }

    const AnalysedProblem& problem;
    const Prices prices;

    // What it costs to execute an action where these parts of its cost are due; nothing where there is no action.
    Cost cost(std::optional<ActionId> action, std::span<const CostPartId> due_parts) const {
        Cost sum = action ? prices.actions[*action] : 0;
        for (const CostPartId part : due_parts) {
            sum = add_bounds(sum, prices.parts[part]);
        }
        return sum;
    }
    // By ActionId: those that cost nothing, whatever the state is.
    std::vector<bool> free_actions() const;
    // Prices for lower bounds: see `shift_costs`.
    const Prices& shifted_prices(Limits& limits) const;
    // By TaskId, from the shifted prices: see `tdg_bound`.
    const std::vector<Cost>& task_bounds(Limits& limits) const;
    // At the shifted prices, both of them.
    const RelaxedModel& composition_model(Limits& limits) const;
    const RelaxedModel& decomposition_model(Limits& limits) const;

private:
    OnDemand<Prices> shifted_prices_;
    OnDemand<std::vector<Cost>> task_bounds_;
    OnDemand<RelaxedModel> composition_model_;
    OnDemand<RelaxedModel> decomposition_model_;
};

}  // namespace relax

#endif
