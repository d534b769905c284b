#ifndef RELAX_GROUNDING_OBJECT_SET_HPP
#define RELAX_GROUNDING_OBJECT_SET_HPP

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "relax/base/bits.hpp"
#include "relax/base/ids.hpp"

namespace relax::grounding {

// A set of objects: a bit for each, and its members in the order in which they
// came.
class ObjectSet {
public:
    explicit ObjectSet(std::size_t object_count = 0) : words_(words_for(object_count), 0) {}

    bool contains(ObjectId object) const { return has_bit(words_, object); }
    std::span<const ObjectId> members() const { return members_; }
    std::size_t size() const { return members_.size(); }
    bool empty() const { return members_.empty(); }

    // Returns whether it is new.
    bool add(ObjectId object) {
        if (contains(object)) {
            return false;
        }
        set_bit(words_, object);
        members_.push_back(object);
        return true;
    }

    template <typename Keep>
    void keep_if(Keep keep) {
        std::vector<ObjectId> kept;
        for (const ObjectId object : members_) {
            if (keep(object)) {
                kept.push_back(object);
            } else {
                clear_bit(words_, object);
            }
        }
        members_ = std::move(kept);
    }

    void intersect(const ObjectSet& other) {
        keep_if([&](ObjectId object) { return other.contains(object); });
    }

private:
    std::vector<std::uint64_t> words_;
    std::vector<ObjectId> members_;
};

}  // namespace relax::grounding

#endif
