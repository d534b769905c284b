#ifndef RELAX_NETWORKS_ORDERED_TASKS_HPP
#define RELAX_NETWORKS_ORDERED_TASKS_HPP

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relax/base/bits.hpp"
#include "relax/base/ids.hpp"

namespace relax {

// Tasks with a transitively closed strict order: for each a row of bits, its predecessors.
struct OrderedTasks {
    std::vector<TaskId> tasks;
    std::size_t words = 0;                    // of a row
    std::vector<std::uint64_t> predecessors;  // rows, one after the other

    void reset(std::size_t count) {
        tasks.assign(count, TaskId{});
        words = words_for(count);
        predecessors.assign(count * words, 0);
    }
    std::span<const std::uint64_t> row(std::size_t index) const {
        assert(index < tasks.size());
        return {predecessors.data() + index * words, words};
    }
    void put_before(std::size_t earlier, std::size_t later) {
        assert(earlier < tasks.size() && later < tasks.size() && earlier != later);
        set_bit(std::span(predecessors).subspan(later * words, words), earlier);
    }
    bool is_before(std::size_t earlier, std::size_t later) const { return has_bit(row(later), earlier); }
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

}  // namespace relax

#endif
