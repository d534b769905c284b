#include "relation.hpp"

#include <algorithm>
#include <cassert>

namespace relax::grounding {

std::optional<TupleId> Relation::find(std::span<const ObjectId> tuple) const {
    assert(tuple.size() == arity_ || size_ == 0);
    return table_.find(hash_values(tuple), [&](TupleId other) { return std::ranges::equal((*this)[other], tuple); });
}

TupleId Relation::add(std::span<const ObjectId> tuple) {
    assert(tuple.size() == arity_);
    const std::uint64_t hash = hash_values(tuple);
    const auto equal = [&](TupleId other) { return std::ranges::equal((*this)[other], tuple); };
    if (const auto known = table_.find(hash, equal)) {
        return *known;
    }
    values_.append(tuple.begin(), tuple.end());
    table_.add(hash, size_);
    const TupleId fresh = size_++;
    for (Index& index : indexes_) {
        if (index.is_complete) {
            insert(index, fresh);
        }
    }
    return fresh;
}

IndexId Relation::index_on(const std::vector<std::uint32_t>& positions, Limits& limits) {
    return index_on(positions, false, limits);
}

IndexId Relation::complete_index_on(const std::vector<std::uint32_t>& positions, Limits& limits) const {
    return index_on(positions, true, limits);
}

IndexId Relation::index_on(const std::vector<std::uint32_t>& positions, bool is_complete, Limits& limits) const {
    assert(std::ranges::is_sorted(positions));
    assert(positions.empty() || positions.back() < arity_ || size_ == 0);
    const auto known = std::ranges::find_if(
        indexes_, [&](const Index& index) { return index.is_complete == is_complete && index.positions == positions; });
    const auto id = static_cast<IndexId>(known - indexes_.begin());
    if (known == indexes_.end()) {
        Index index;
        index.positions = positions;
        index.is_complete = is_complete;
        for (TupleId tuple = 0; tuple < (is_complete ? size_ : visible_); ++tuple) {
            limits.stop_if_reached();
            insert(index, tuple);
        }
        indexes_.push_back(std::move(index));
    }
    return id;
}

void Relation::show_next() {
    assert(visible_ < size_);
    for (Index& index : indexes_) {
        if (!index.is_complete) {
            insert(index, visible_);
        }
    }
    ++visible_;
}

void Relation::show_all(Limits& limits) {
    while (visible_ < size_) {
        limits.stop_if_reached();
        show_next();
    }
}

void Relation::insert(Index& index, TupleId tuple) const {
    assert(index.older.size() == tuple);
    std::vector<ObjectId> key;
    key.reserve(index.positions.size());
    for (const std::uint32_t position : index.positions) {
        key.push_back((*this)[tuple][position]);
    }
    if (const auto known = find_key(index, key)) {
        index.older.push_back(index.newest[*known]);
        index.newest[*known] = tuple;
        ++index.count[*known];
        return;
    }
    const auto fresh = static_cast<std::uint32_t>(index.newest.size());
    index.older.push_back(tuple);
    index.newest.push_back(tuple);
    index.count.push_back(1);
    index.table.add(hash_values(key), fresh);
}

std::optional<std::uint32_t> Relation::find_key(const Index& index, std::span<const ObjectId> key) const {
    assert(key.size() == index.positions.size());
    return index.table.find(hash_values(key), [&](std::uint32_t other) {
        const std::span<const ObjectId> tuple = (*this)[index.newest[other]];
        for (std::size_t at = 0; at < key.size(); ++at) {
            if (tuple[index.positions[at]] != key[at]) {
                return false;
            }
        }
        return true;
    });
}

std::optional<TupleId> Relation::first(IndexId index, std::span<const ObjectId> key) const {
    const auto found = find_key(indexes_[index], key);
    return found ? std::optional(indexes_[index].newest[*found]) : std::nullopt;
}

std::size_t Relation::count(IndexId index, std::span<const ObjectId> key) const {
    assert(indexes_[index].is_complete);
    const auto found = find_key(indexes_[index], key);
    return found ? indexes_[index].count[*found] : 0;
}

std::optional<TupleId> Relation::next(IndexId index, TupleId tuple) const {
    const TupleId older = indexes_[index].older[tuple];
    return older == tuple ? std::nullopt : std::optional(older);
}

std::size_t Relation::distinct_values(std::uint32_t position) {
    assert(position < arity_);
    if (distinct_.empty() || counted_ != size_) {
        counted_ = size_;
        distinct_.clear();
        for (std::size_t column = 0; column < arity_; ++column) {
            std::vector<bool> is_seen;
            std::size_t count = 0;
            for (TupleId tuple = 0; tuple < size_; ++tuple) {
                const ObjectId value = (*this)[tuple][column];
                if (value >= is_seen.size()) {
                    is_seen.resize(value + 1, false);
                }
                count += is_seen[value] ? 0 : 1;
                is_seen[value] = true;
            }
            distinct_.push_back(count);
        }
    }
    return distinct_[position];
}

}  // namespace relax::grounding
