#include "relax/valuations/law_orders.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace relax {

namespace {

bool is_at_most(double one, double other) { return one <= other + kExcessTolerance * other; }

}  // namespace

// The difference of the two probabilities of more than a cost is largest where the other's falls, at its outcomes.
bool is_never_more(const Law& one, const Law& other, double until) {
    std::size_t from = 0;  // outcomes of the one up to that of the other
    for (std::size_t j = 0; j < other.size() && other.at[j] <= until; ++j) {
        while (from < one.size() && one.at[from] <= other.at[j]) {
            ++from;
        }
        if (one.above_of(from) > other.above[j] + kProbabilityTolerance) {
            return false;
        }
    }
    return true;
}

// The difference of the two excesses is piecewise linear. It bends down only at outcomes of the other law, so that it
// is largest at one of them, at `until`, or below all outcomes, where it is that of the means.
bool has_no_larger_excess(const Law& one, const Law& other, double until) {
    if (!is_at_most(one.mean(), other.mean())) {
        return false;
    }
    std::size_t from = 0;
    for (std::size_t j = 0; j < other.size() && other.at[j] <= until; ++j) {
        while (from < one.size() && one.at[from] <= other.at[j]) {
            ++from;
        }
        if (!is_at_most(one.excess_over(other.at[j], from), other.excess[j])) {
            return false;
        }
    }
    return std::isinf(until) || has_no_larger_excess_over(one, other, until);
}

bool has_no_larger_excess_over(const Law& one, const Law& other, double cost) {
    return is_at_most(one.excess_over(cost), other.excess_over(cost));
}

}  // namespace relax
