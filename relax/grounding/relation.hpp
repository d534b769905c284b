#ifndef RELAX_GROUNDING_RELATION_HPP
#define RELAX_GROUNDING_RELATION_HPP

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relax/base/flat_array.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"

namespace relax::grounding {

using RelationId = std::uint32_t;
using TupleId = std::uint32_t;  // in a relation, in order of arrival
using IndexId = std::uint32_t;  // of a relation

// A growing set of tuples of objects: the facts of a predicate, or the
// instances of a task. Tuples become visible to joins one after the other, in
// order; indexes hold the visible ones.
class Relation {
public:
    explicit Relation(std::size_t arity) : arity_(arity) {}

    std::size_t arity() const { return arity_; }
    TupleId size() const { return size_; }
    TupleId visible_count() const { return visible_; }
    std::span<const ObjectId> operator[](TupleId tuple) const {
        assert(tuple < size_);
        return {values_.data() + tuple * arity_, arity_};
    }

    std::optional<TupleId> find(std::span<const ObjectId> tuple) const;
    // Returns the tuple's number, whether it is new or not. `tuple` must not
    // point into the relation.
    TupleId add(std::span<const ObjectId> tuple);

    // The index on these positions (ascending, perhaps none), made where there is
    // none yet.
    IndexId index_on(const std::vector<std::uint32_t>& positions, Limits& limits);  // throws Stopped
    // Let joins see the next tuple, or all of them.
    void show_next();
    void show_all(Limits& limits);  // throws Stopped
    // The tuples in the index with these values at its positions, newest first.
    std::optional<TupleId> first(IndexId index, std::span<const ObjectId> key) const;
    std::optional<TupleId> next(IndexId index, TupleId tuple) const;

    // The same for all tuples, visible or not: for questions whose answer must not depend on how far joins have come.
    IndexId complete_index_on(const std::vector<std::uint32_t>& positions, Limits& limits) const;
    // How many tuples have these values; of complete indexes.
    std::size_t count(IndexId index, std::span<const ObjectId> key) const;

    // Counted anew only where the relation has grown since.
    std::size_t distinct_values(std::uint32_t position);

private:
    struct Index {
        std::vector<std::uint32_t> positions;
        bool is_complete = false;        // holds all tuples, not only the visible ones
        IdTable<> table;                 // of keys, numbered in order of arrival
        FlatArray<TupleId> newest;       // by key
        FlatArray<std::uint32_t> count;  // by key
        FlatArray<TupleId> older;        // by tuple: the one before with the same key,
                                         // or the tuple itself
    };

    IndexId index_on(const std::vector<std::uint32_t>& positions, bool is_complete, Limits& limits) const;
    void insert(Index& index, TupleId tuple) const;
    std::optional<std::uint32_t> find_key(const Index& index, std::span<const ObjectId> key) const;

    std::size_t arity_;
    TupleId size_ = 0;
    TupleId visible_ = 0;
    FlatArray<ObjectId> values_;
    IdTable<> table_;
    mutable std::vector<Index> indexes_;  // complete ones are made when they are first asked for
    TupleId counted_ = 0;                 // size at which `distinct_` was counted
    std::vector<std::size_t> distinct_;   // by position
};

}  // namespace relax::grounding

#endif
