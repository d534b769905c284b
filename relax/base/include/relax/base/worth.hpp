#ifndef RELAX_BASE_WORTH_HPP
#define RELAX_BASE_WORTH_HPP

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace relax {

// What a plan is worth to an agent, minimised: a whole number that orders plans as their values do. It is a cost in
// units where costs add up, and `order_of` a value where they do not; nothing is scaled, nothing lost.
using Worth = std::int64_t;

// Of what is no plan, or none that is wanted.
inline constexpr Worth kNoWorth = std::numeric_limits<Worth>::max();

// The order of doubles as whole numbers: those of equal sign are ordered as their bits are (IEEE 754).
inline Worth order_of(double value) {
    const auto bits = std::bit_cast<std::int64_t>(value + 0.0);  // no negative zero
    return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits;
}

inline double value_of(Worth order) {
    return std::bit_cast<double>(order >= 0 ? order : std::numeric_limits<std::int64_t>::min() - order);
}

// Besides a plan of this worth, plans are wanted that are worth less than what is returned. Where worths are values,
// plans that are better by less than `tolerance` are not asked for, in parts of the value, or of 1 if that is more:
// bounds are rounded down, so that all ways to plans that are equally good would have to be followed.
inline Worth better_than(Worth worth, double tolerance) {
    if (tolerance == 0 || worth == kNoWorth) {
        return worth;
    }
    const double value = value_of(worth);
    return order_of(value - tolerance * std::max(1.0, std::abs(value)));
}

}  // namespace relax

#endif
