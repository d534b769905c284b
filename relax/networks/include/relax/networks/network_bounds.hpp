#ifndef RELAX_NETWORKS_NETWORK_BOUNDS_HPP
#define RELAX_NETWORKS_NETWORK_BOUNDS_HPP

#include <span>

#include "relax/base/ids.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/task_network.hpp"

namespace relax {

// What networks cost at least, by one vector of bounds of tasks: of each the sum over its tasks. It takes constant time
// where networks are lists, since it is found for one network after the other, in the order in which they were made:
// each time from those that it is made of.
class NetworkBounds {
public:
    // `task_bounds`: by TaskId, see tdg_bound. Networks and bounds must live longer.
    NetworkBounds(const TaskNetworks& networks, std::span<const Cost> task_bounds)
        : networks_(networks), task_bounds_(task_bounds) {}

    Cost operator[](NetworkId network) {
        while (network >= by_network_.size()) {
            by_network_.push_back(
                networks_.bound(static_cast<NetworkId>(by_network_.size()), task_bounds_, by_network_, by_component_));
        }
        return by_network_[network];
    }

private:
    const TaskNetworks& networks_;
    std::span<const Cost> task_bounds_;
    SegmentedArray<Cost> by_network_;
    SegmentedArray<Cost> by_component_;
};

}  // namespace relax

#endif
