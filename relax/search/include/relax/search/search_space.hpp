#ifndef RELAX_SEARCH_SEARCH_SPACE_HPP
#define RELAX_SEARCH_SEARCH_SPACE_HPP

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "relax/base/cost.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/network_bounds.hpp"
#include "relax/networks/task_network.hpp"
#include "relax/problem/state.hpp"
#include "relax/search/search_node.hpp"

namespace relax {

// Every node that a search has met. Of all nodes with one state and networks of one form (TaskNetworks::form) only the
// best is known. Completing a network costs a fixed amount more than completing another one of its form, the difference
// of their bounds; hence a node with network N and cost g is as good as one with N' and g' if
// g + bound(N) <= g' + bound(N'). Among equals the one with fewer tasks is better.
//
// No optimal plan is lost. Of all nodes through which a plan of optimal cost goes, known or not, take a known one from
// which such a plan takes the fewest steps. Suppose it is expanded. The plan's next node was generated, so that it is
// known or another one as good is, with no more tasks and hence no more steps to go: fewer than from the node taken,
// which is a contradiction. So the node taken is open. (It is here that fewer tasks must be better: executing actions
// that together change nothing leads to the same state and form at the same sum, and is progress all the same.)
class SearchSpace {
public:
    SearchSpace(const TaskNetworks& networks, NetworkBounds& bounds) : networks_(networks), bounds_(bounds) {}

    SearchNode& operator[](NodeId id) { return nodes_[id]; }
    const SearchNode& operator[](NodeId id) const { return nodes_[id]; }
    std::size_t size() const { return nodes_.size(); }

    std::optional<NodeId> find(StateId state, NetworkId network) const {
        const FormId form = networks_.form(network);
        return table_.find(hash(state, form), [&](NodeId id) {
            return nodes_[id].state == state && networks_.form(nodes_[id].network) == form;
        });
    }

    // Add a node for a state and a network that are not yet there.
    NodeId add(StateId state, NetworkId network) {
        assert(!find(state, network));
        const auto id = static_cast<NodeId>(nodes_.size());
        nodes_.push_back({0, 0, state, network, id, 0, SearchNode::kExecuted, 0, false, false, false});
        table_.add(hash(state, networks_.form(network)), id);
        return id;
    }

    // Returns the node for a state and a network that have been reached at cost g; nothing where one as good is known.
    std::optional<NodeId> add_if_better(StateId state, NetworkId network, Cost g) {
        const auto known = find(state, network);
        if (!known) {
            return add(state, network);
        }
        return is_as_good(nodes_[*known], network, g) ? std::nullopt : std::optional(replace(*known, network));
    }

private:
    bool is_as_good(const SearchNode& known, NetworkId network, Cost g) const {
        const Cost by_known = known.g + bounds_[known.network];
        const Cost by_new = g + bounds_[network];
        return by_known < by_new || (by_known == by_new && networks_.size(known.network) <= networks_.size(network));
    }

    // Returns the node that is known from now on: the same if the network is the same; otherwise a new one, since the
    // steps that lead on from the old one are steps in its own network. The costs to come differ by the difference of
    // the bounds, and h, a lower bound of the old one's, becomes a lower bound of the new one's by that difference.
    NodeId replace(NodeId old, NetworkId network) {
        if (nodes_[old].network == network) {
            return old;
        }
        const auto id = static_cast<NodeId>(nodes_.size());
        nodes_.push_back(nodes_[old]);
        nodes_[id].network = network;
        if (nodes_[id].h < kInfinity) {
            nodes_[id].h += bounds_[network] - bounds_[nodes_[old].network];
        }
        nodes_[old].is_expanded = true;
        table_.replace(hash(old), old, id);
        return id;
    }

    std::uint64_t hash(NodeId id) const { return hash(nodes_[id].state, networks_.form(nodes_[id].network)); }
    static std::uint64_t hash(StateId state, FormId form) { return mix((std::uint64_t{state} << 32) | form); }

    const TaskNetworks& networks_;
    NetworkBounds& bounds_;
    SegmentedArray<SearchNode> nodes_;
    IdTable<NodeId> table_;
};

}  // namespace relax

#endif
