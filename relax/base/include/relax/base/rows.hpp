#ifndef RELAX_BASE_ROWS_HPP
#define RELAX_BASE_ROWS_HPP

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "relax/base/flat_array.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"

namespace relax {

// Rows of different lengths in two flat arrays (compressed sparse rows). `Index`: what numbers the rows.
template <typename Value, typename Index = std::size_t>
class Rows {
public:
    using Row = Index;

    std::size_t size() const { return ends_.size(); }

    std::span<const Value> operator[](Index row) const {
        assert(row < size());
        const std::size_t begin = row == 0 ? 0 : ends_[row - 1];
        return {values_.data() + begin, ends_[row] - begin};
    }

    // So many rows. `visit` gets a function that puts a value at the end of what a row has so far. It is called twice,
    // the first time only to count, and must put the same both times.
    template <typename Visit>
    static Rows filled(std::size_t count, Visit visit) {
        std::vector<std::uint32_t> lengths(count, 0);
        visit([&lengths](Index row, const Value&) { ++lengths[row]; });
        Rows rows;
        std::uint32_t begin = 0;
        for (const std::uint32_t length : lengths) {
            rows.ends_.push_back(begin);  // moves on to the end as the row is filled
            begin += length;
        }
        rows.values_.resize(begin, Value{});
        visit([&rows](Index row, const Value& value) { rows.values_[rows.ends_[row]++] = value; });
        assert(rows.ends_.size() == 0 || rows.ends_[rows.size() - 1] == begin);
        return rows;
    }

    // Append to the row that `finish_row` will close.
    void push(const Value& value) { values_.push_back(value); }
    void finish_row() { ends_.push_back(static_cast<std::uint32_t>(values_.size())); }

    void clear() {
        ends_.clear();
        values_.clear();
    }

    template <typename Range>
    void add_row(const Range& range) {
        values_.append(std::begin(range), std::end(range));
        finish_row();
    }

private:
    FlatArray<std::uint32_t> ends_;
    FlatArray<Value> values_;
};

// By value below `count`: the rows that have it, in order, once for each time that they have it. Rows for which
// `keep(row)` does not hold are left out. Throws Stopped.
template <typename Value, typename Index, typename Keep>
Rows<Index, Value> invert(const Rows<Value, Index>& rows, std::size_t count, Limits& limits, Keep keep) {
    return Rows<Index, Value>::filled(count, [&](auto put) {
        for (std::uint32_t row = 0; row < rows.size(); ++row) {
            limits.stop_if_reached();
            if (keep(Index(row))) {
                std::ranges::for_each(rows[Index(row)], [&](const Value& value) { put(value, Index(row)); });
            }
        }
    });
}
template <typename Value, typename Index>
Rows<Index, Value> invert(const Rows<Value, Index>& rows, std::size_t count, Limits& limits) {
    return invert(rows, count, limits, [](Index) { return true; });
}

// Ids that are dealt out in order: each owner has the next few. Owners, too, are ids, and come in order.
template <typename Owner, typename Member>
class Shares {
public:
    std::size_t size() const { return ends_.size(); }

    auto operator[](Owner owner) const {
        const auto [begin, end] = bounds(owner);
        return ids_between<Member>(begin, end);
    }
    std::pair<std::uint32_t, std::uint32_t> bounds(std::size_t owner) const {
        assert(owner < size());
        return {owner == 0 ? 0 : ends_[owner - 1], ends_[owner]};
    }

    // Give the next owner the members that come before the number `end` and have no owner yet.
    void share_out(std::size_t end) {
        assert(ends_.empty() || ends_.back() <= end);
        ends_.push_back(static_cast<std::uint32_t>(end));
    }

private:
    std::vector<std::uint32_t> ends_;
};

}  // namespace relax

#endif
