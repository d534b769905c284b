#ifndef RELAX_BASE_ID_TABLE_HPP
#define RELAX_BASE_ID_TABLE_HPP

#include <bit>
#include <cassert>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace relax {

// Mix the bits of a word so that nearby words land far apart (the finaliser of MurmurHash3).
inline std::uint64_t mix(std::uint64_t word) {
    word ^= word >> 33;
    word *= 0xff51afd7ed558ccdULL;
    word ^= word >> 33;
    word *= 0xc4ceb9fe1a85ec53ULL;
    return word ^ (word >> 33);
}

inline std::uint64_t combine(std::uint64_t seed, std::uint64_t word) {
    return mix(seed * 0x9e3779b97f4a7c15ULL + word + 1);
}

template <typename Range>
std::uint64_t hash_values(const Range& values) {
    std::uint64_t hash = values.size();
    for (const auto value : values) {
        hash = combine(hash, value);
    }
    return hash;
}

// A hash table of dense numbers whose keys live elsewhere: open addressing, linear probing. Half of each hash is kept,
// so that full keys are compared only when they are very likely equal.
template <typename Index = std::uint32_t>
class IdTable {
public:
    // Find an element with this hash for which `equal(id)` holds.
    template <typename Equal>
    std::optional<Index> find(std::uint64_t hash, Equal equal) const {
        if (slots_.empty()) {
            return std::nullopt;
        }
        const auto tag = static_cast<std::uint32_t>(hash >> 32);
        for (std::size_t at = hash & mask();; at = (at + 1) & mask()) {
            const Slot& slot = slots_[at];
            if (slot.id == kEmpty) {
                return std::nullopt;
            }
            if (slot.tag == tag && equal(slot.id)) {
                return slot.id;
            }
        }
    }

    // Add an element that is not yet there. Its low 32 bits of hash are found again from `hash_of` when the table
    // grows.
    template <typename HashOf>
    void add(std::uint64_t hash, Index id, HashOf hash_of) {
        assert(id != kEmpty);
        if (4 * (count_ + 1) > 3 * slots_.size()) {
            std::vector<Slot> old(slots_.empty() ? kFirstSlots : 2 * slots_.size(), Slot{kEmpty, 0});
            old.swap(slots_);
            for (const Slot& slot : old) {
                if (slot.id != kEmpty) {
                    place(hash_of(slot.id), slot);
                }
            }
        }
        place(hash, {id, static_cast<std::uint32_t>(hash >> 32)});
        ++count_;
    }

    // Put an element in the place of another one with this hash.
    void replace(std::uint64_t hash, Index old, Index id) {
        assert(id != kEmpty && !slots_.empty());
        std::size_t at = hash & mask();
        while (slots_[at].id != old) {
            assert(slots_[at].id != kEmpty);
            at = (at + 1) & mask();
        }
        slots_[at].id = id;
    }

private:
    struct Slot {
        Index id;
        std::uint32_t tag;
    };
    static constexpr std::size_t kFirstSlots = 16;
    static_assert(std::has_single_bit(kFirstSlots));
    static constexpr Index kEmpty{std::numeric_limits<std::uint32_t>::max()};

    std::size_t mask() const { return slots_.size() - 1; }

    void place(std::uint64_t hash, Slot slot) {
        assert(count_ < slots_.size());
        std::size_t at = hash & mask();
        while (slots_[at].id != kEmpty) {
            at = (at + 1) & mask();
        }
        slots_[at] = slot;
    }

    std::vector<Slot> slots_;  // a power of two
    std::size_t count_ = 0;
};

}  // namespace relax

#endif
