#include "relax/valuations/scenario_totals.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace relax {

namespace {

// Beyond it neither the objective nor a budget tells costs from each other; infinite where there is no such cost.
double last_of(const LawObjective& objective, std::span<const ScenarioBudget> budgets) {
    const auto own = [](const LawDetail& detail) {
        return detail.is_flat_beyond ? detail.last : std::numeric_limits<double>::infinity();
    };
    double last = own(objective.detail());
    for (const ScenarioBudget& budget : budgets) {
        last = std::max(last, own(budget.deadline->detail()));
    }
    return last;
}

}  // namespace

ScenarioTotals::ScenarioTotals(const std::vector<const PricedProblem*>& prices, std::vector<double> probabilities,
                               std::vector<ScenarioTangent> tangents, bool asks_scenarios,
                               std::shared_ptr<const LawObjective> objective, std::vector<ScenarioBudget> budgets,
                               const ScenarioOptions& options)
    : ScenarioValuation(std::move(tangents), prices, asks_scenarios, std::move(objective), std::move(budgets), options),
      sums_(prices),
      probabilities_(std::move(probabilities)),
      last_(last_of(this->objective(), this->budgets())) {
    assert(probabilities_.size() == sums_.prices().size());
}

Worth ScenarioTotals::worth(ValueId value) {
    const std::span<const Cost> sums = sums_[value];
    mixture_.clear();
    for (std::size_t k = 0; k < sums.size(); ++k) {
        mixture_.add(static_cast<double>(sums[k]), probabilities_[k]);
    }
    return worth_of(mixture_.law());
}

Worth ScenarioTotals::bound(ValueId value, const CostToCome& to_come, std::uint32_t /*stage*/) {
    if (to_come.is_dead_end()) {
        return kNoWorth;
    }
    const std::span<const Cost> sums = sums_[value];
    const std::span<const Cost> least = least_by_scenario(to_come);
    mixture_.clear();
    for (std::size_t k = 0; k < sums.size(); ++k) {
        const Cost ideal = options().ideal_bound ? add_bounds(sums[k], least[k]) : sums[k];
        mixture_.add(static_cast<double>(ideal), probabilities_[k]);
    }
    return bound_of(mixture_.law(), value, to_come);
}

double ScenarioTotals::spent(ValueId value, const ScenarioTangent& tangent) const {
    const std::span<const Cost> sums = sums_[value];
    double sum = 0.0;
    for (std::size_t k = 0; k < sums.size(); ++k) {
        sum += tangent.weights[k] * static_cast<double>(sums[k]);
    }
    return sum;
}

bool ScenarioTotals::is_as_good(ValueId one, ValueId other, const CostToCome& to_come) {
    if (one == other) {
        return true;
    }
    if (!options().compare_scenarios) {
        return false;
    }
    const std::span<const Cost> ones = sums_[one];
    const std::span<const Cost> others = sums_[other];
    const std::span<const Cost> least = least_by_scenario(to_come);
    for (std::size_t k = 0; k < ones.size(); ++k) {
        const bool is_decided =
            options().decided_scenarios && static_cast<double>(add_bounds(others[k], least[k])) > last_;
        if (ones[k] > others[k] && !is_decided) {
            return false;
        }
    }
    return true;
}

}  // namespace relax
