#ifndef RELAX_BASE_COST_HPP
#define RELAX_BASE_COST_HPP

#include <cassert>

#include "relax/base/ids.hpp"

namespace relax {

// What has no end at all: a task without a finite decomposition, a dead end.
inline constexpr Cost kInfinity = Cost{1} << 62;

// Sums of costs that are finite go no further than this: it stands for every larger one. Searches leave out what costs
// so much, and say so by `SearchStatus::GaveUp` where that may have been the only plan.
inline constexpr Cost kMostCost = kInfinity - 1;

// The sum of two costs, each at most `kInfinity`. It is monotone in both, so that a bound stays a bound.
inline Cost add_bounds(Cost left, Cost right) {
    assert(left <= kInfinity && right <= kInfinity);
    const Cost sum = left + right;
    if (sum < kMostCost) {
        return sum;
    }
    return left >= kInfinity || right >= kInfinity ? kInfinity : kMostCost;
}

}  // namespace relax

#endif
