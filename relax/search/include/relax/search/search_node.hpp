#ifndef RELAX_SEARCH_SEARCH_NODE_HPP
#define RELAX_SEARCH_SEARCH_NODE_HPP

#include <cstdint>
#include <limits>
#include <optional>

#include "relax/analysis/tdg_bound.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/progression/progression.hpp"

namespace relax {

using NodeId = std::uint32_t;

// A pair of state and network, and the cheapest way to it that is known.
struct SearchNode {
    Cost g;
    Cost h;  // a lower bound of the cost to come
    StateId state;
    NetworkId network;
    NodeId parent;  // itself for the root
    std::uint32_t occurrence;
    MethodId method;                // kExecuted where the step executed an action
    std::uint8_t heuristics_asked;  // how many; `h` includes what they told
    bool is_expanded;               // at its present g
    bool is_forced;                 // its parent has no other successor
    bool is_followed;               // there are several ways to go on

    static constexpr MethodId kExecuted = std::numeric_limits<MethodId>::max();

    void reach(NodeId from, Cost cost, const SearchStep& step) {
        parent = from;
        g = cost;
        occurrence = step.occurrence;
        method = step.method.value_or(kExecuted);
        is_expanded = false;
        is_forced = false;
    }
    SearchStep step() const { return {occurrence, method == kExecuted ? std::nullopt : std::optional(method)}; }
};

// Every node that the search has met: of those with the same state and form of network, the cheapest one is known.
class DuplicateRegistry {
public:
    explicit DuplicateRegistry(const TaskNetworks& networks) : networks_(networks) {}

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
    // is the same, or else a new one, since what the old one led to goes on from its own network.
    NodeId replace(NodeId old, NetworkId network) {
        if (nodes_[old].network == network) {
            return old;
        }
        const auto id = static_cast<NodeId>(nodes_.size());
        nodes_.push_back(nodes_[old]);
        nodes_[id].network = network;
        if (nodes_[id].h < kNoDecomposition) {
            nodes_[id].h += networks_.bound(network) - networks_.bound(nodes_[old].network);
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
