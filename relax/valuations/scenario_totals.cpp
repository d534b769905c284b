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

ScenarioTotals::ScenarioTotals(std::vector<const PricedProblem*> prices, std::vector<double> probabilities,
                               std::vector<ScenarioTangent> tangents, bool asks_scenarios,
                               std::shared_ptr<const LawObjective> objective, std::vector<ScenarioBudget> budgets,
                               const ScenarioOptions& options)
    : sums_(std::move(prices)),
      probabilities_(std::move(probabilities)),
      tangents_(std::move(tangents)),
      asks_scenarios_(asks_scenarios),
      objective_(std::move(objective)),
      budgets_(std::move(budgets)),
      options_(options),
      last_(last_of(*objective_, budgets_)) {
    assert(probabilities_.size() == sums_.prices().size() && !tangents_.empty());
    for (const ScenarioTangent& tangent : tangents_) {
        prices_.push_back(tangent.priced);
    }
    std::ranges::copy(sums_.prices(), std::back_inserter(prices_));
}

Worth ScenarioTotals::worth(ValueId value) {
    const std::span<const Cost> sums = sums_[value];
    mixture_.clear();
    for (std::size_t k = 0; k < sums.size(); ++k) {
        mixture_.add(static_cast<double>(sums[k]), probabilities_[k]);
    }
    const Law& law = mixture_.law();
    const auto is_missed = [&](const ScenarioBudget& budget) { return budget.deadline->value(law) > budget.most; };
    return std::ranges::any_of(budgets_, is_missed) ? kNoWorth : order_of(objective_->value(law));
}

Worth ScenarioTotals::bound(ValueId value, const CostToCome& to_come, std::uint32_t /*stage*/) {
    if (std::ranges::any_of(to_come.least, [](Cost least) { return least >= kInfinity; })) {
        return kNoWorth;
    }
    const std::span<const Cost> sums = sums_[value];
    const std::span<const Cost> least = least_totals(to_come);
    mixture_.clear();
    for (std::size_t k = 0; k < sums.size(); ++k) {
        const Cost ideal = options_.ideal_bound ? add_bounds(sums[k], least[k]) : sums[k];
        mixture_.add(static_cast<double>(ideal), probabilities_[k]);
    }
    const Law& law = mixture_.law();
    for (const ScenarioBudget& budget : budgets_) {
        if (budget.deadline->bound(law, 0.0) > budget.most) {
            return kNoWorth;
        }
    }
    double bound = objective_->bound(law, 0.0);
    if (options_.tangent_bound && objective_->is_concave()) {
        for (std::size_t i = 0; i < tangents_.size(); ++i) {
            bound = std::max(bound, tangents_[i].bound(spent(value, tangents_[i]), to_come.least[i]));
        }
    }
    return order_of(bound);
}

double ScenarioTotals::spent(ValueId value, const ScenarioTangent& tangent) const {
    const std::span<const Cost> sums = sums_[value];
    double sum = 0.0;
    for (std::size_t k = 0; k < sums.size(); ++k) {
        sum += tangent.weights[k] * static_cast<double>(sums[k]);
    }
    return sum;
}

Cost ScenarioTotals::tie_break(ValueId value, const CostToCome& to_come) {
    const ScenarioTangent& first = tangents_.front();
    return first.tie_break(spent(value, first), to_come.least.front());
}

bool ScenarioTotals::is_as_good(ValueId one, ValueId other, const CostToCome& to_come) {
    if (one == other) {
        return true;
    }
    if (!options_.compare_scenarios) {
        return false;
    }
    const std::span<const Cost> ones = sums_[one];
    const std::span<const Cost> others = sums_[other];
    const std::span<const Cost> least = least_totals(to_come);
    for (std::size_t k = 0; k < ones.size(); ++k) {
        const bool is_decided =
            options_.decided_scenarios && static_cast<double>(add_bounds(others[k], least[k])) > last_;
        if (ones[k] > others[k] && !is_decided) {
            return false;
        }
    }
    return true;
}

}  // namespace relax
