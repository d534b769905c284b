#include "relax/search/forced_cycle.hpp"

#include <algorithm>

namespace relax {

namespace {

constexpr std::uint32_t kLongestCycle = 64;  // in steps

}  // namespace

bool ForcedCycle::closes(const SearchSpace& nodes, const TaskNetworks& networks, NodeId node) {
    const auto task = first(networks, nodes[node].network);
    std::uint32_t smallest = networks.size(nodes[node].network);
    NodeId before = node;
    for (std::uint32_t step = 0; task && step < kLongestCycle && nodes[before].is_forced; ++step) {
        before = nodes[before].parent;
        const NetworkId network = nodes[before].network;
        smallest = std::min(smallest, networks.size(network));
        const auto earlier = first(networks, network);
        if (!earlier) {
            return false;
        }
        if (*earlier == *task && nodes[before].state == nodes[node].state && networks.size(network) <= smallest) {
            return true;
        }
    }
    return false;
}

std::optional<TaskId> ForcedCycle::first(const TaskNetworks& networks, NetworkId network) {
    unconstrained_.clear();
    networks.unconstrained(network, unconstrained_);
    return unconstrained_.size() == 1 ? std::optional(unconstrained_.front().task) : std::nullopt;
}

}  // namespace relax
