#ifndef RELAX_RELATION_HPP
#define RELAX_RELATION_HPP

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "relax/id_table.hpp"
#include "relax/ids.hpp"

namespace relax {

using TupleId = std::uint32_t;

// A growing set of tuples of objects, with indexes on chosen positions. Tuples are kept in order of insertion; joins
// see only those that have been shown.
class Relation {
public:
    explicit Relation(std::size_t arity) : arity_(arity) {}

    std::size_t arity() const { return arity_; }
    std::size_t size() const { return size_; }
    std::span<const ObjectId> operator[](TupleId id) const { return {objects_.data() + id * arity_, arity_}; }

    // Returns the tuple's number, and whether it is new.
    std::pair<TupleId, bool> insert(std::span<const ObjectId> tuple);
    std::optional<TupleId> find(std::span<const ObjectId> tuple) const;
    // Let joins see the next tuple that they do not see yet.
    void show_next();
    std::size_t shown() const { return shown_; }

    // An index on these positions (in ascending order); the same one for the same positions.
    std::uint32_t index_on(const std::vector<std::uint32_t>& positions);

    // Visit every shown tuple whose objects at the index's positions are those of the key. The visitor may insert
    // tuples.
    template <typename Visitor>
    void for_each_match(std::uint32_t index, std::span<const ObjectId> key, Visitor visit) const {
        const Index& chosen = indexes_[index];
        const auto bucket = find_bucket(chosen, key);
        if (!bucket) {
            return;
        }
        for (std::uint32_t id = chosen.first[*bucket]; id != kEnd; id = indexes_[index].next[id]) {
            visit(id);
        }
    }

private:
    static constexpr std::uint32_t kEnd = static_cast<std::uint32_t>(-1);

    struct Index {
        std::vector<std::uint32_t> positions;
        IdTable buckets;
        std::vector<TupleId> first;  // by bucket: the newest tuple
        std::vector<TupleId> next;   // by tuple: an older one of the same bucket
    };

    std::uint64_t hash_key(const Index& index, std::span<const ObjectId> tuple) const;
    std::optional<std::uint32_t> find_bucket(const Index& index, std::span<const ObjectId> key) const;
    void add_to_index(Index& index, TupleId id);

    std::size_t arity_;
    std::size_t size_ = 0;
    std::size_t shown_ = 0;
    std::vector<ObjectId> objects_;
    IdTable table_;
    std::vector<Index> indexes_;
};

}  // namespace relax

#endif
