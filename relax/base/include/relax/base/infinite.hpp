#ifndef RELAX_BASE_INFINITE_HPP
#define RELAX_BASE_INFINITE_HPP

#include <limits>

namespace relax {

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace relax

#endif
