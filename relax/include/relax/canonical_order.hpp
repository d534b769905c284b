#ifndef RELAX_CANONICAL_ORDER_HPP
#define RELAX_CANONICAL_ORDER_HPP

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relax/ids.hpp"

namespace relax {

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

// Finds an order of the occurrences that depends on the network's structure alone, as far as colour refinement with
// individualisation can tell: by number of predecessors, then by colour. Interchangeable occurrences may come in any
// order.
class CanonicalOrder {
public:
    // Returns the old index for each new one; valid until the next call.
    std::span<const std::uint32_t> of(const OrderedTasks& network);

private:
    void colour(const OrderedTasks& network);
    void refine(const OrderedTasks& network);
    void sort();
    bool are_twins(const OrderedTasks& network, std::uint32_t left, std::uint32_t right) const;

    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> predecessor_count_;
    std::vector<std::uint64_t> colours_;
    std::vector<std::uint64_t> from_predecessors_;
    std::vector<std::uint64_t> from_successors_;
    std::vector<std::uint64_t> sorted_;
};

}  // namespace relax

#endif
