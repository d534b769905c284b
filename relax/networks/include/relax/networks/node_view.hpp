#ifndef RELAX_NETWORKS_NODE_VIEW_HPP
#define RELAX_NETWORKS_NODE_VIEW_HPP

#include <cstdint>
#include <span>

#include "relax/base/ids.hpp"

namespace relax {

// What a heuristic sees of a search node.
struct NodeView {
    std::span<const std::uint64_t> state;  // bits by FactId
    std::span<const TaskId> tasks;         // of the network, with repetitions
    // Their order: as they stand, or for each a row of bits for those before it, one after the other. No rows: nothing
    // is known of their order.
    bool is_totally_ordered = false;
    std::span<const std::uint64_t> predecessors = {};
    Cost tdg_bound = 0;  // of the network, at the prices of the heuristic that is asked
};

}  // namespace relax

#endif
