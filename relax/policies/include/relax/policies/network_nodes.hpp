#ifndef RELAX_POLICIES_NETWORK_NODES_HPP
#define RELAX_POLICIES_NETWORK_NODES_HPP

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/heuristics/selective_heuristic.hpp"
#include "relax/networks/network_bounds.hpp"
#include "relax/policies/decision_graph.hpp"
#include "relax/progression/policy_progression.hpp"

namespace relax {

using PairId = Id<struct PairTag>;

// What is left of an amount, in steps of a grid; `kSpent` where it is used up and nothing depends on it any more.
using AmountLeft = std::int32_t;
inline constexpr AmountLeft kSpent = std::numeric_limits<AmountLeft>::min();

// The nodes of a policy search in numbers: a state and a network (a pair), and what is left of an amount where that is
// remembered. Nodes are those of a decision graph, in the order in which they were added to it.
class NetworkNodes {
public:
    explicit NetworkNodes(PolicyProgression& progression) : progression_(progression) {}

    struct Node {
        PairId pair;
        AmountLeft left;
    };

    PairId pair_of(StateId state, NetworkId network);
    StateId state(PairId pair) const { return pairs_[pair].state; }
    NetworkId network(PairId pair) const { return pairs_[pair].network; }
    std::size_t pair_count() const { return pairs_.size(); }

    const Node& operator[](PolicyNodeId node) const { return nodes_[node]; }
    // The node, or the number that it will have when it is added.
    PolicyNodeId find(PairId pair, AmountLeft left) const;
    bool has(PolicyNodeId node) const { return node < nodes_.size(); }
    void add(PairId pair, AmountLeft left);

private:
    struct Pair {
        StateId state;
        NetworkId network;
    };

    static std::uint64_t hash_of(const Pair& pair) { return combine(pair.state, pair.network); }
    static std::uint64_t hash_of(const Node& node) { return combine(node.pair, static_cast<std::uint32_t>(node.left)); }

    PolicyProgression& progression_;
    SegmentedArray<Pair> pairs_;
    IdTable<PairId> pair_table_;
    SegmentedArray<Node> nodes_;
    IdTable<PolicyNodeId> node_table_;
};

// What pairs cost at least at one vector of prices: by the decomposition graph, and by a heuristic that is asked once.
class PairBounds {
public:
    PairBounds(const PricedProblem& priced, const HeuristicInfo& heuristic, PolicyProgression& progression,
               const NetworkNodes& nodes, Limits& limits);  // throws Stopped

    // As far as is known by now; kInfinity for a dead end.
    Cost known(PairId pair);
    // After a closer look. Throws Stopped.
    Cost closer(PairId pair);

private:
    struct Entry {
        Cost bound;
        bool is_asked;  // the heuristic
        bool is_met;    // by a closer look, with or without the heuristic
    };

    bool is_affordable();

    PolicyProgression& progression_;
    const NetworkNodes& nodes_;
    NetworkBounds network_bounds_;
    SelectiveHeuristic heuristic_;
    SegmentedArray<Entry> entries_;
    std::size_t met_pairs_ = 0;
};

}  // namespace relax

#endif
