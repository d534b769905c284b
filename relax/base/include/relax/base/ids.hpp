#ifndef RELAX_BASE_IDS_HPP
#define RELAX_BASE_IDS_HPP

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "relax/base/flat_array.hpp"

namespace relax {

// Index spaces. Each is dense and starts at 0.
using ObjectId = std::uint32_t;
using FactId = std::uint32_t;
using ActionId = std::uint32_t;
using EffectId = std::uint32_t;
using CostPartId = std::uint32_t;
using MethodId = std::uint32_t;
// An action is the task of the same number; compound tasks follow the actions.
using TaskId = std::uint32_t;

// Fixed-point cost: the unit is chosen per problem, so that sums are exact.
using Cost = std::int64_t;

// Rows of different lengths in two flat arrays (compressed sparse rows).
template <typename Value>
class Rows {
public:
    std::size_t size() const { return ends_.size(); }
    std::size_t bytes() const { return ends_.size() * sizeof(std::uint32_t) + values_.size() * sizeof(Value); }

    std::span<const Value> operator[](std::size_t row) const {
        const std::size_t begin = row == 0 ? 0 : ends_[row - 1];
        return {values_.data() + begin, ends_[row] - begin};
    }

    // Rows of the given lengths. `fill` gets a function that puts a value at the end of what a row has so far, and must
    // call it as often as the lengths say.
    template <typename Fill>
    static Rows filled(const std::vector<std::uint32_t>& lengths, Fill fill) {
        Rows rows;
        std::uint32_t begin = 0;
        for (const std::uint32_t length : lengths) {
            rows.ends_.push_back(begin);  // moves on to the end as the row is filled
            begin += length;
        }
        rows.values_.resize(begin, Value{});
        fill([&rows](std::size_t row, const Value& value) { rows.values_[rows.ends_[row]++] = value; });
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

}  // namespace relax

#endif
