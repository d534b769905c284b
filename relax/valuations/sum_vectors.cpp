#include "relax/valuations/sum_vectors.hpp"

#include <algorithm>
#include <cassert>

namespace relax {

namespace {

std::uint64_t hash_of(std::span<const Cost> sums) {
    std::uint64_t hash = sums.size();
    for (const Cost sum : sums) {
        hash = combine(hash, static_cast<std::uint64_t>(sum));
    }
    return hash;
}

}  // namespace

ValueId SumVectors::start() {
    std::ranges::fill(sums_, 0);
    return intern();
}

ValueId SumVectors::extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) {
    const std::span<const Cost> before = (*this)[value];
    for (std::size_t price = 0; price < prices_.size(); ++price) {
        sums_[price] = add_bounds(before[price], prices_[price]->cost(action, due_parts));
    }
    return intern();
}

ValueId SumVectors::intern() {
    const std::uint64_t hash = hash_of(sums_);
    if (const auto known = table_.find(hash, [&](ValueId id) { return std::ranges::equal((*this)[id], sums_); })) {
        return *known;
    }
    const auto id = static_cast<ValueId>(rows_.size());
    const std::span<Cost> row = costs_.allocate(sums_.size());
    std::ranges::copy(sums_, row.begin());
    rows_.push_back(row.data());
    table_.add(hash, id);
    return id;
}

}  // namespace relax
