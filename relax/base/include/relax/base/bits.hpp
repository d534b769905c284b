#ifndef RELAX_BASE_BITS_HPP
#define RELAX_BASE_BITS_HPP

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace relax {

// Visit the numbers of the bits that are set, in words of 64.
template <typename Visit>
void for_each_bit(std::span<const std::uint64_t> row, Visit visit) {
    for (std::size_t word = 0; word < row.size(); ++word) {
        for (std::uint64_t bits = row[word]; bits != 0; bits &= bits - 1) {
            visit(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
        }
    }
}

inline bool intersect(std::span<const std::uint64_t> left, std::span<const std::uint64_t> right) {
    for (std::size_t word = 0; word < left.size(); ++word) {
        if ((left[word] & right[word]) != 0) {
            return true;
        }
    }
    return false;
}

}  // namespace relax

#endif
