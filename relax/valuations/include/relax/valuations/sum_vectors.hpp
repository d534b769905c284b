#ifndef RELAX_VALUATIONS_SUM_VECTORS_HPP
#define RELAX_VALUATIONS_SUM_VECTORS_HPP

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/cost.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/valuations/valuation.hpp"

namespace relax {

// What ways have cost at several vectors of prices: of each way as many sums, each vector of sums kept once.
class SumVectors {
public:
    // The prices must live longer; at least one.
    explicit SumVectors(std::vector<const PricedProblem*> prices) : prices_(std::move(prices)), sums_(prices_.size()) {}

    std::span<const PricedProblem* const> prices() const { return prices_; }
    std::span<const Cost> operator[](ValueId value) const { return {rows_[value], prices_.size()}; }
    // Whether none of its sums is larger than the other's.
    bool is_nowhere_more(ValueId one, ValueId other) const {
        return std::ranges::equal((*this)[one], (*this)[other], std::less_equal<>());
    }
    ValueId start();
    ValueId extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts);

private:
    ValueId intern();

    std::vector<const PricedProblem*> prices_;
    std::vector<Cost> sums_;  // the vector that is looked for
    RunArena<Cost> costs_;
    SegmentedArray<const Cost*> rows_;
    IdTable<ValueId> table_;
};

}  // namespace relax

#endif
