#ifndef RELAX_SEARCH_SEARCH_SPACE_HPP
#define RELAX_SEARCH_SEARCH_SPACE_HPP

#include <cstddef>
#include <cstdint>
#include <optional>

#include "relax/base/cost.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/task_network.hpp"
#include "relax/problem/state.hpp"
#include "relax/search/search_node.hpp"

namespace relax {

// Every node that the search has met: of those with the same state and form of network, the cheapest one is known.
class SearchSpace {
public:
    explicit SearchSpace(const TaskNetworks& networks) : networks_(networks) {}

    SearchNode& operator[](NodeId id) { return nodes_[id]; }
    const SearchNode& operator[](NodeId id) const { return nodes_[id]; }
    std::size_t size() const { return nodes_.size(); }

    std::optional<NodeId> find(StateId state, NetworkId network) const {
        const FormId form = networks_.form(network);
        return table_.find(hash(state, form), [&](NodeId id) {
            return nodes_[id].state == state && networks_.form(nodes_[id].network) == form;
        });
    }

    // Add a node for a pair that is not yet there.
    NodeId add(StateId state, NetworkId network) {
        const auto id = static_cast<NodeId>(nodes_.size());
        nodes_.push_back({0, 0, state, network, id, 0, SearchNode::kExecuted, 0, false, false, false});
        table_.add(hash(state, networks_.form(network)), id, [this](NodeId other) { return hash(other); });
        return id;
    }

    // Returns the node to be known in the place of the old one, for a network of the same form: itself if the network
    // is the same, or else a new one, since what the old one led to goes on from its own network. `more`: how much more
    // than the old one's the new network's bound is.
    NodeId replace(NodeId old, NetworkId network, Cost more) {
        if (nodes_[old].network == network) {
            return old;
        }
        const auto id = static_cast<NodeId>(nodes_.size());
        nodes_.push_back(nodes_[old]);
        nodes_[id].network = network;
        if (nodes_[id].h < kInfinity) {
            nodes_[id].h += more;
        }
        nodes_[old].is_expanded = true;
        table_.replace(hash(old), old, id);
        return id;
    }

private:
    std::uint64_t hash(NodeId id) const { return hash(nodes_[id].state, networks_.form(nodes_[id].network)); }
    static std::uint64_t hash(StateId state, FormId form) { return mix((std::uint64_t{state} << 32) | form); }

    const TaskNetworks& networks_;
    SegmentedArray<SearchNode> nodes_;
    IdTable table_;
};

}  // namespace relax

#endif
