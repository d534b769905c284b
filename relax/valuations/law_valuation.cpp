#include "relax/valuations/law_valuation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "relax/base/cost.hpp"
#include "relax/valuations/law_orders.hpp"

namespace relax {

namespace {

LawDetail detail_of_labels(const LawObjective& objective, const LawOptions& options) {
    LawDetail detail = objective.detail();
    if (objective.is_concave()) {
        detail.most_outcomes = options.label_outcomes;
        detail.keeps_means = true;
    }
    return detail;
}

// The c for which E max(X, c) = mean, rounded down, if it is above the least outcome.
double floor_for_mean(const Law& law, double mean) {
    // The mean rises with the floor: find the outcomes between which it gets there.
    std::size_t low = 0;
    std::size_t high = law.size();
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        const double floored = law.at[middle] + law.excess[middle];
        (floored <= mean ? low : high) = floored <= mean ? middle + 1 : middle;
    }
    if (low == 0) {
        return 0.0;
    }
    // From there on the floor has the probability of all outcomes up to it.
    const double left = mean - law.at[low - 1] - law.excess[low - 1];
    const double weight = 1.0 - law.above[low - 1];
    const double rise = weight > kLawRounding ? left / weight : 0.0;
    const double floor = law.at[low - 1] + (low < law.size() ? std::min(rise, law.at[low] - law.at[low - 1]) : rise);
    return floor - kLawRounding * mean;
}

}  // namespace

LawValuation::LawValuation(const PricedProblem& least, const PricedProblem& means, double units_per_step,
                           const CostLaws& costs, std::shared_ptr<const LawObjective> objective,
                           const LawOptions& options)
    : units_per_step_(units_per_step),
      objective_(std::move(objective)),
      options_(options),
      so_far_(costs, detail_of_labels(*objective_, options_)),
      to_come_(least, costs, objective_->detail(), options) {
    if (options.least_bound && !needs_means()) {
        least_index_ = prices_.size();
        prices_.push_back(&least);
    }
    mean_index_ = prices_.size();
    prices_.push_back(&means);
}

void LawValuation::begin(const TaskNetworks& networks, Limits& limits) {
    limits_ = &limits;
    if (options_.graph_bound) {
        to_come_.begin(networks, limits);
    }
}

ValueId LawValuation::extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) {
    const LawId law = so_far_.extend(LawId(std::uint32_t{value}), action, due_parts, *limits_);
    return ValueId(std::uint32_t{law});
}

Worth LawValuation::worth(ValueId value) { return order_of(objective_->value(law(value))); }

Worth LawValuation::bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) {
    if (to_come.is_dead_end()) {
        return kNoWorth;
    }
    if (stage == 0) {
        return order_of(objective_->bound(law(value), floor(to_come, nullptr)));
    }
    const Law& graph = to_come_.of(to_come.network, *limits_);
    FlooredLaw floored(graph, floor(to_come, &graph));
    return order_of(objective_->bound_of_sum(law(value), floored));
}

// What is to come can be taken to be at least this (see above); `graph`: if it is also at least that.
double LawValuation::floor(const CostToCome& to_come, const Law* graph) const {
    const double least = options_.least_bound ? least_to_come(to_come) : 0.0;
    if (!needs_means()) {
        return least;
    }
    const double mean = mean_to_come(to_come);
    return std::max(least, graph != nullptr ? floor_for_mean(*graph, mean) : mean);
}

double LawValuation::least_to_come(const CostToCome& to_come) const {
    return least_index_ ? static_cast<double>(to_come.least[*least_index_]) : 0.0;
}

double LawValuation::mean_to_come(const CostToCome& to_come) const {
    return static_cast<double>(to_come.least[*mean_index_]) / units_per_step_;
}

Cost LawValuation::tie_break(ValueId value, const CostToCome& to_come) {
    const double mean = law(value).mean() * units_per_step_ + static_cast<double>(to_come.least[*mean_index_]);
    return mean < static_cast<double>(kMostCost) ? static_cast<Cost>(mean) : kMostCost;
}

bool LawValuation::is_as_good(ValueId one, ValueId other, const CostToCome& to_come) {
    return one == other || relax::is_as_good(*objective_, options_, law(one), law(other), least_to_come(to_come));
}

bool is_as_good(const LawObjective& objective, const LawOptions& options, const Law& one, const Law& other,
                double least) {
    // What the objective tells from each other only by its mean begins here for the law of what was spent.
    const LawDetail detail = objective.detail();
    const double last = detail.last - (options.pairwise ? least : 0.0);
    if (options.convex_order && objective.is_concave()) {
        return has_no_larger_excess(one, other, last);
    }
    if (options.stochastic_order && is_never_more(one, other, last) &&
        (detail.is_flat_beyond || std::isinf(last) || has_no_larger_excess_over(one, other, last))) {
        return true;
    }
    return options.pairwise && objective.is_as_good(one, other, least);
}

}  // namespace relax
