#include "relax/analysis/priced_problem.hpp"

#include <algorithm>

#include "relax/analysis/composition_model.hpp"
#include "relax/analysis/cost_shifting.hpp"
#include "relax/analysis/decomposition_model.hpp"
#include "relax/analysis/tdg_bound.hpp"

namespace relax {

std::vector<bool> PricedProblem::free_actions() const {
    std::vector<bool> is_free;
    for (const ActionId action : problem.actions()) {
        is_free.push_back(prices.actions[action] == 0 &&
                          std::ranges::all_of(problem.cost_parts[action],
                                              [this](CostPartId part) { return prices.parts[part] == 0; }));
    }
    return is_free;
}

const Prices& PricedProblem::shifted_prices(Limits& limits) const {
    return shifted_prices_.get([&] { return shift_costs(problem, prices, limits); });
}

const std::vector<Cost>& PricedProblem::task_bounds(Limits& limits) const {
    return task_bounds_.get([&] { return tdg_bound(problem, shifted_prices(limits).actions, limits); });
}

const RelaxedModel& PricedProblem::composition_model(Limits& limits) const {
    return composition_model_.get([&] { return relax::composition_model(problem, shifted_prices(limits), limits); });
}

const RelaxedModel& PricedProblem::decomposition_model(Limits& limits) const {
    return decomposition_model_.get(
        [&] { return relax::decomposition_model(problem, task_bounds(limits), shifted_prices(limits).parts, limits); });
}

}  // namespace relax
