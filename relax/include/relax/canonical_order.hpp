#ifndef RELAX_CANONICAL_ORDER_HPP
#define RELAX_CANONICAL_ORDER_HPP

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relax/ids.hpp"
#include "relax/limits.hpp"

namespace relax {

template <typename Visit>
void for_each_bit(std::span<const std::uint64_t> row, Visit visit) {
    for (std::size_t word = 0; word < row.size(); ++word) {
        for (std::uint64_t bits = row[word]; bits != 0; bits &= bits - 1) {
            visit(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
        }
    }
}

inline bool intersect(std::span<const std::uint64_t> left, std::span<const std::uint64_t> right) {
    for (std::size_t word = 0; word < left.size(); ++word) {
        if ((left[word] & right[word]) != 0) {
            return true;
        }
    }
    return false;
}

// Tasks with a transitively closed strict order: for each a row of bits, its predecessors.
struct OrderedTasks {
    std::vector<TaskId> tasks;
    std::size_t words = 0;                    // of a row
    std::vector<std::uint64_t> predecessors;  // rows, one after the other

    void reset(std::size_t count) {
        tasks.assign(count, 0);
        words = (count + 63) / 64;
        predecessors.assign(count * words, 0);
    }
    std::span<const std::uint64_t> row(std::size_t index) const { return {predecessors.data() + index * words, words}; }
    void put_before(std::size_t earlier, std::size_t later) {
        predecessors[later * words + earlier / 64] |= std::uint64_t{1} << (earlier % 64);
    }
    bool is_before(std::size_t earlier, std::size_t later) const {
        return (predecessors[later * words + earlier / 64] >> (earlier % 64) & 1U) != 0;
    }
};

// Write the order turned round: for each task its successors.
inline void turn_round(const OrderedTasks& network, OrderedTasks& reverse) {
    reverse.tasks = network.tasks;
    reverse.words = network.words;
    reverse.predecessors.assign(network.predecessors.size(), 0);
    for (std::size_t later = 0; later < network.tasks.size(); ++later) {
        for_each_bit(network.row(later), [&](std::size_t earlier) { reverse.put_before(later, earlier); });
    }
}

// Finds an order of the occurrences that depends on the network's structure alone, as far as colour refinement with
// individualisation can tell: by number of predecessors, then by colour. Interchangeable occurrences may come in any
// order.
class CanonicalOrder {
public:
    explicit CanonicalOrder(Limits& limits) : limits_(limits) {}

    // Returns the old index for each new one; valid until the next call. Throws Stopped.
    std::span<const std::uint32_t> of(const OrderedTasks& network);

    // How many occurrences, pairs of the order and words of it have been looked at so far, again and again.
    std::uint64_t work() const { return work_; }

private:
    void colour(const OrderedTasks& network);
    void refine(const OrderedTasks& network);
    void sort();
    bool are_twins(const OrderedTasks& network, std::uint32_t left, std::uint32_t right);

    Limits& limits_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> predecessor_count_;
    std::vector<std::uint64_t> colours_;
    std::vector<std::uint64_t> from_predecessors_;
    std::vector<std::uint64_t> from_successors_;
    std::vector<std::uint64_t> sorted_;
    OrderedTasks successors_;        // the network's order turned round
    bool knows_successors_ = false;  // they are made for the first pair that needs them
    std::uint64_t work_ = 0;
};

}  // namespace relax

#endif
