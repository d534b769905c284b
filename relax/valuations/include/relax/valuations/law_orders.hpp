#ifndef RELAX_VALUATIONS_LAW_ORDERS_HPP
#define RELAX_VALUATIONS_LAW_ORDERS_HPP

#include <limits>

#include "relax/valuations/law.hpp"

namespace relax {

// Laws that would be equal but for rounding must be as good as each other, or their number would grow without need. So
// probabilities that are compared may be off by this. A way that was left out for another one, and that one for a third
// and so on, costs so much each time: 2^-46 for each of seventy actions is 1e-12.
inline constexpr double kProbabilityTolerance = 0x1p-46;
// Likewise for expected excesses, relative to them.
inline constexpr double kExcessTolerance = 0x1p-40;

// Whether no cost up to `until` is exceeded with a higher probability by the one than by the other: the usual
// stochastic order, as far as that.
//
// Let Y be independent of both, at least h, and `until` = L - h. No function u that is flat beyond L has a higher
// expectation of one + Y than of other + Y if it does not fall: given Y = y, u(x + y) is a function of min(x, until)
// that does not fall. (Without L: the stochastic order is kept by sums with the same independent cost.)
bool is_never_more(const Law& one, const Law& other, double until = std::numeric_limits<double>::infinity());

// Whether the expected excess over no cost up to `until` is higher: the increasing convex order, as far as that.
//
// With Y as above, no convex function u that does not fall and is linear beyond L has a higher expectation: given
// Y = y, u(x + y) is a sum of a linear function that does not fall and of positive multiples of max(x - z, 0) with
// z <= L - y <= until. (Without L: a limit of such functions.)
bool has_no_larger_excess(const Law& one, const Law& other, double until = std::numeric_limits<double>::infinity());

// Whether the expected excess over one cost is not higher. Together with `is_never_more` up to there it says the same
// of functions that are linear beyond L and do not fall: u(x + y) is then a function of min(x, until) that does not
// fall and a positive multiple of max(x - until, 0).
bool has_no_larger_excess_over(const Law& one, const Law& other, double cost);

}  // namespace relax

#endif
