#ifndef RELAX_BASE_WORTH_HPP
#define RELAX_BASE_WORTH_HPP

#include <bit>
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

}  // namespace relax

#endif
