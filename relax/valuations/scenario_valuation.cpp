#include "relax/valuations/scenario_valuation.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace relax {

ScenarioValuation::ScenarioValuation(std::vector<ScenarioTangent> tangents,
                                     std::vector<const PricedProblem*> by_scenario, bool asks_scenarios,
                                     std::shared_ptr<const LawObjective> objective, std::vector<ScenarioBudget> budgets,
                                     const ScenarioOptions& options)
    : tangents_(std::move(tangents)),
      asks_scenarios_(asks_scenarios),
      objective_(std::move(objective)),
      budgets_(std::move(budgets)),
      options_(options) {
    assert(!tangents_.empty());
    for (const ScenarioTangent& tangent : tangents_) {
        prices_.push_back(tangent.priced);
    }
    prices_.insert(prices_.end(), by_scenario.begin(), by_scenario.end());
}

Worth ScenarioValuation::worth_of(const Law& law) const {
    const auto is_missed = [&](const ScenarioBudget& budget) { return budget.deadline->value(law) > budget.most; };
    return std::ranges::any_of(budgets_, is_missed) ? kNoWorth : order_of(objective_->value(law));
}

Worth ScenarioValuation::bound_of(const Law& law, ValueId value, const CostToCome& to_come) const {
    const auto is_missed = [&](const ScenarioBudget& budget) { return budget.deadline->bound(law, 0.0) > budget.most; };
    if (std::ranges::any_of(budgets_, is_missed)) {
        return kNoWorth;
    }
    double bound = objective_->bound(law, 0.0);
    if (options_.tangent_bound && objective_->is_concave()) {
        for (std::size_t i = 0; i < tangents_.size(); ++i) {
            bound = std::max(bound, tangents_[i].bound(spent(value, tangents_[i]), to_come.least[i]));
        }
    }
    return order_of(bound);
}

Cost ScenarioValuation::tie_break(ValueId value, const CostToCome& to_come) {
    const ScenarioTangent& first = tangents_.front();
    return first.tie_break(spent(value, first), to_come.least.front());
}

}  // namespace relax
