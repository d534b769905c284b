#ifndef RELAX_BASE_ID_TABLE_HPP
#define RELAX_BASE_ID_TABLE_HPP

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

// A hash table of dense numbers whose keys live elsewhere: open addressing, linear probing. The upper half of each hash
// is kept; its first bits say where an element belongs, and full keys are compared only where all of it is equal. So
// elements stand in the order of their hashes, but for collisions, and a table that grows reads the old slots and
// writes the new ones from the first to the last, without a look at any key: 0.1 seconds for some 10^7 elements.
template <typename Index = std::uint32_t>
class IdTable {
public:
    // Find an element with this hash for which `equal(id)` holds.
    template <typename Equal>
    std::optional<Index> find(std::uint64_t hash, Equal equal) const {
        if (slots_.empty()) {
            return std::nullopt;
        }
        const std::uint32_t tag = tag_of(hash);
        for (std::size_t at = home(tag);; at = next(at)) {
            const Slot& slot = slots_[at];
            if (slot.id == kEmpty) {
                return std::nullopt;
            }
            if (slot.tag == tag && equal(slot.id)) {
                return slot.id;
            }
        }
    }

    // Add an element that is not yet there.
    void add(std::uint64_t hash, Index id) {
        assert(id != kEmpty);
        if (4 * (count_ + 1) > 3 * slots_.size()) {
            grow();
        }
        place({id, tag_of(hash)});
        ++count_;
    }

    // Put an element in the place of another one with this hash.
    void replace(std::uint64_t hash, Index old, Index id) {
        assert(id != kEmpty && !slots_.empty());
        std::size_t at = home(tag_of(hash));
        while (slots_[at].id != old) {
            assert(slots_[at].id != kEmpty);
            at = next(at);
        }
        slots_[at].id = id;
    }

private:
    struct Slot {
        Index id;
        std::uint32_t tag;
    };
    static constexpr unsigned kTagBits = 32;
    static constexpr unsigned kFirstBits = 4;  // 16 slots
    static constexpr Index kEmpty{std::numeric_limits<std::uint32_t>::max()};

    static std::uint32_t tag_of(std::uint64_t hash) { return static_cast<std::uint32_t>(hash >> kTagBits); }
    std::size_t home(std::uint32_t tag) const { return tag >> shift_; }
    std::size_t next(std::size_t at) const { return (at + 1) & (slots_.size() - 1); }

    void grow() {
        shift_ = slots_.empty() ? kTagBits - kFirstBits : shift_ - 1;
        assert(shift_ < kTagBits);  // more slots than tags would need more memory than there is
        std::vector<Slot> old(std::size_t{1} << (kTagBits - shift_), Slot{kEmpty, 0});
        old.swap(slots_);
        for (const Slot& slot : old) {
            if (slot.id != kEmpty) {
                place(slot);
            }
        }
    }

    void place(Slot slot) {
        assert(count_ < slots_.size());
        std::size_t at = home(slot.tag);
        while (slots_[at].id != kEmpty) {
            at = next(at);
        }
        slots_[at] = slot;
    }

    std::vector<Slot> slots_;    // a power of two
    unsigned shift_ = kTagBits;  // of a tag, to the number of its slot
    std::size_t count_ = 0;
};

}  // namespace relax

#endif
