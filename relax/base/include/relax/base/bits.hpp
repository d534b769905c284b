#ifndef RELAX_BASE_BITS_HPP
#define RELAX_BASE_BITS_HPP

#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace relax {

// Rows of bits, in words of 64.
inline std::size_t words_for(std::size_t bits) { return (bits + 63) / 64; }

inline bool has_bit(std::span<const std::uint64_t> row, std::size_t bit) {
    assert(bit / 64 < row.size());
    return (row[bit / 64] >> (bit % 64) & 1U) != 0;
}
inline void set_bit(std::span<std::uint64_t> row, std::size_t bit) {
    assert(bit / 64 < row.size());
    row[bit / 64] |= std::uint64_t{1} << (bit % 64);
}
inline void clear_bit(std::span<std::uint64_t> row, std::size_t bit) {
    assert(bit / 64 < row.size());
    row[bit / 64] &= ~(std::uint64_t{1} << (bit % 64));
}

// Visit the numbers of the bits that are set.
template <typename Visit>
void for_each_bit(std::span<const std::uint64_t> row, Visit visit) {
    for (std::size_t word = 0; word < row.size(); ++word) {
        for (std::uint64_t bits = row[word]; bits != 0; bits &= bits - 1) {
            visit(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
        }
    }
}

inline bool intersect(std::span<const std::uint64_t> left, std::span<const std::uint64_t> right) {
    assert(left.size() == right.size());
    for (std::size_t word = 0; word < left.size(); ++word) {
        if ((left[word] & right[word]) != 0) {
            return true;
        }
    }
    return false;
}

inline void unite(std::span<std::uint64_t> into, std::span<const std::uint64_t> other) {
    assert(into.size() == other.size());
    for (std::size_t word = 0; word < into.size(); ++word) {
        into[word] |= other[word];
    }
}

inline void keep_common(std::span<std::uint64_t> into, std::span<const std::uint64_t> other) {
    assert(into.size() == other.size());
    for (std::size_t word = 0; word < into.size(); ++word) {
        into[word] &= other[word];
    }
}

}  // namespace relax

#endif
