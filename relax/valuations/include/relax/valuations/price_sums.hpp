#ifndef RELAX_VALUATIONS_PRICE_SUMS_HPP
#define RELAX_VALUATIONS_PRICE_SUMS_HPP

#include <span>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/cost.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/valuations/valuation.hpp"

namespace relax {

// What actions cost adds up, each at its price: a plan is worth its cost in units.
class PriceSums final : public Valuation {
public:
    explicit PriceSums(const PricedProblem& priced) : priced_(&priced) {}

    std::span<const PricedProblem* const> prices() const override { return {&priced_, 1}; }
    ValueId start() override { return intern(0); }
    ValueId extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) override {
        return intern(add_bounds(sums_[value], priced_->cost(action, due_parts)));
    }
    Worth worth(ValueId value) override { return sums_[value]; }
    Worth bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) override;
    Cost tie_break(ValueId /*value*/, const CostToCome& to_come) override { return to_come.least.front(); }
    bool is_as_good(ValueId one, ValueId other, const CostToCome& /*to_come*/) override {
        return sums_[one] <= sums_[other];
    }
    bool is_total_order() const override { return true; }
    Worth most() const override { return kMostCost; }

private:
    ValueId intern(Cost sum);

    const PricedProblem* priced_;
    SegmentedArray<Cost> sums_;
    IdTable<ValueId> table_;
};

}  // namespace relax

#endif
