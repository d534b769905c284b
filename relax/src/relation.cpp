#include "relation.hpp"

#include <algorithm>

namespace relax {

namespace {

std::uint64_t hash_objects(std::span<const ObjectId> objects) {
    std::uint64_t hash = objects.size();
    for (const ObjectId object : objects) {
        hash = combine(hash, object);
    }
    return hash;
}

}  // namespace

std::pair<TupleId, bool> Relation::insert(std::span<const ObjectId> tuple) {
    if (const auto known = find(tuple)) {
        return {*known, false};
    }
    const auto id = static_cast<TupleId>(size_++);
    objects_.insert(objects_.end(), tuple.begin(), tuple.end());
    table_.add(hash_objects((*this)[id]), id, [this](TupleId other) { return hash_objects((*this)[other]); });
    return {id, true};
}

std::optional<TupleId> Relation::find(std::span<const ObjectId> tuple) const {
    return table_.find(hash_objects(tuple), [&](TupleId id) { return std::ranges::equal((*this)[id], tuple); });
}

void Relation::show_next() {
    const auto id = static_cast<TupleId>(shown_++);
    for (Index& index : indexes_) {
        add_to_index(index, id);
    }
}

std::uint32_t Relation::index_on(const std::vector<std::uint32_t>& positions) {
    for (std::uint32_t index = 0; index < indexes_.size(); ++index) {
        if (indexes_[index].positions == positions) {
            return index;
        }
    }
    indexes_.push_back({positions, {}, {}, {}});
    for (TupleId id = 0; id < shown_; ++id) {
        add_to_index(indexes_.back(), id);
    }
    return static_cast<std::uint32_t>(indexes_.size() - 1);
}

std::uint64_t Relation::hash_key(const Index& index, std::span<const ObjectId> tuple) const {
    std::uint64_t hash = index.positions.size();
    for (const std::uint32_t position : index.positions) {
        hash = combine(hash, tuple[position]);
    }
    return hash;
}

std::optional<std::uint32_t> Relation::find_bucket(const Index& index, std::span<const ObjectId> key) const {
    return index.buckets.find(hash_objects(key), [&](std::uint32_t bucket) {
        const auto tuple = (*this)[index.first[bucket]];
        for (std::size_t at = 0; at < key.size(); ++at) {
            if (tuple[index.positions[at]] != key[at]) {
                return false;
            }
        }
        return true;
    });
}

void Relation::add_to_index(Index& index, TupleId id) {
    std::vector<ObjectId> key;
    for (const std::uint32_t position : index.positions) {
        key.push_back((*this)[id][position]);
    }
    index.next.push_back(kEnd);
    if (const auto bucket = find_bucket(index, key)) {
        index.next[id] = index.first[*bucket];
        index.first[*bucket] = id;
        return;
    }
    index.first.push_back(id);
    index.buckets.add(hash_objects(key), static_cast<std::uint32_t>(index.first.size() - 1),
                      [&](std::uint32_t bucket) { return hash_key(index, (*this)[index.first[bucket]]); });
}

}  // namespace relax
