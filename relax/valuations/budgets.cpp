#include "relax/valuations/budgets.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "relax/base/cost.hpp"
#include "relax/valuations/law_orders.hpp"
#include "relax/valuations/quantile.hpp"

namespace relax {

namespace {

// Beyond the largest budget costs are not told from each other.
LawDetail detail_for(std::span<const Budget> budgets) {
    assert(!budgets.empty());
    return {.last = std::ranges::max(budgets, {}, &Budget::steps).steps, .is_flat_beyond = true};
}

double tail_of(const Budget& budget) { return 1.0 - budget.probability + kLevelTolerance; }

}  // namespace

Budgets::Budgets(Valuation& inner, const PricedProblem& least, const CostLaws& costs, std::vector<Budget> budgets,
                 const LawOptions& options)
    : inner_(inner),
      budgets_(std::move(budgets)),
      options_(options),
      so_far_(costs, detail_for(budgets_)),
      to_come_(least, costs, detail_for(budgets_), options) {
    const auto asked = inner.prices().first(inner.asked());
    const auto known = std::ranges::find(asked, &least);
    own_prices_ = known == asked.end() ? 1 : 0;
    least_index_ = own_prices_ == 1 ? 0 : static_cast<std::size_t>(known - asked.begin());
    if (own_prices_ == 1) {
        prices_.push_back(&least);
    }
    prices_.insert(prices_.end(), inner.prices().begin(), inner.prices().end());
}

void Budgets::begin(const TaskNetworks& networks, Limits& limits) {
    limits_ = &limits;
    inner_.begin(networks, limits);
    if (options_.graph_bound) {
        to_come_.begin(networks, limits);
    }
}

ValueId Budgets::extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) {
    const Value before = values_[value];
    const ValueId inner = inner_.extend(before.inner, action, due_parts);
    return intern({inner, so_far_.extend(before.law, action, due_parts, *limits_)});
}

Worth Budgets::worth(ValueId value) {
    const Law& law = so_far_[values_[value].law];
    const bool keeps_all = std::ranges::all_of(
        budgets_, [&](const Budget& budget) { return law.above_cost(budget.steps) <= tail_of(budget); });
    return keeps_all ? inner_.worth(values_[value].inner) : kNoWorth;
}

std::uint32_t Budgets::stages() const { return std::max(inner_.stages(), options_.graph_bound ? 2U : 1U); }

Worth Budgets::bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) {
    const Law& law = so_far_[values_[value].law];
    const double least = least_to_come(to_come);
    if (!can_keep_all(law, least)) {
        return kNoWorth;
    }
    if (stage > 0 && options_.graph_bound) {
        FlooredLaw floored(to_come_.of(to_come.network, *limits_), least);
        if (!can_keep_all(law, floored)) {
            return kNoWorth;
        }
    }
    return inner_.bound(values_[value].inner, of_inner(to_come), std::min(stage, inner_.stages() - 1));
}

bool Budgets::can_keep_all(const Law& law, double least) const {
    return std::ranges::all_of(budgets_, [&](const Budget& budget) {
        return law.above_cost(budget.steps - least) <= tail_of(budget) + kLawRounding;
    });
}

bool Budgets::can_keep_all(const Law& law, FlooredLaw& to_come) const {
    return std::ranges::all_of(budgets_, [&](const Budget& budget) {
        return above_of_sum(law, to_come, budget.steps) <= tail_of(budget) + kLawRounding;
    });
}

Cost Budgets::tie_break(ValueId value, const CostToCome& to_come) {
    return inner_.tie_break(values_[value].inner, of_inner(to_come));
}

bool Budgets::is_as_good(ValueId one, ValueId other, const CostToCome& to_come) {
    if (one == other) {
        return true;
    }
    if (!inner_.is_as_good(values_[one].inner, values_[other].inner, of_inner(to_come))) {
        return false;
    }
    const Law& left = so_far_[values_[one].law];
    const Law& right = so_far_[values_[other].law];
    const double least = least_to_come(to_come);
    return std::ranges::all_of(budgets_,
                               [&](const Budget& budget) { return is_never_more(left, right, budget.steps - least); });
}

ValueId Budgets::intern(Value value) {
    const std::uint64_t hash = mix((std::uint64_t{value.inner} << 32) | value.law);
    if (const auto known = table_.find(hash, [&](ValueId id) { return values_[id] == value; })) {
        return *known;
    }
    const auto id = static_cast<ValueId>(values_.size());
    values_.push_back(value);
    table_.add(hash, id);
    return id;
}

}  // namespace relax
