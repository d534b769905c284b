#ifndef RELAX_POLICIES_DECISION_GRAPH_HPP
#define RELAX_POLICIES_DECISION_GRAPH_HPP

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "relax/base/flat_array.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/segmented_array.hpp"

namespace relax {

using PolicyNodeId = Id<struct PolicyNodeTag>;
using DecisionId = Id<struct DecisionTag>;

// The worth of a node from which nothing that is wanted can be reached.
inline constexpr double kNever = std::numeric_limits<double>::infinity();

// To stop at a node instead of deciding: to be done, to give up, or to have failed.
inline constexpr DecisionId kStop{std::numeric_limits<std::uint32_t>::max()};

// A decision as a source hands it over: a constant, and for each outcome a successor and its weight. What these mean is
// said by the recursion (recursion.hpp). `cost`: the expected cost of the step, for ties (see `DecisionGraph`).
struct DraftDecision {
    double constant = 0;
    double cost = 0;
    std::vector<PolicyNodeId> successors;
    std::vector<double> weights;

    void clear() {
        constant = cost = 0;
        successors.clear();
        weights.clear();
    }
};

// The explored part of an AND/OR graph in flat arrays: nodes, of which each is decided once it is expanded; the
// decisions of a node; the outcomes of a decision.
class DecisionGraph {
public:
    struct Node {
        double lower;         // of the worth; never falls
        double stop;          // what it is worth to stop here; kNever where one may not, unless something is reached
        std::uint32_t first;  // of its decisions ...
        std::uint32_t count;  // ... so many; none before it is expanded
        DecisionId choice;    // the best one by the lower worths
        float depth;  // of the policy below, as far as it is explored: among equally good ones the least is taken
        std::uint32_t visited;   // the latest round that came here
        std::uint32_t gathered;  // the latest envelope that has it
        bool is_done;
        bool is_expanded;
    };

    std::size_t size() const { return nodes_.size(); }
    std::size_t decision_count() const { return ends_.size(); }
    Node& operator[](PolicyNodeId node) { return nodes_[node]; }
    const Node& operator[](PolicyNodeId node) const { return nodes_[node]; }

    PolicyNodeId add_done(double worth) { return add({worth, worth, 0, 0, kStop, 0, 0, 0, true, true}); }
    PolicyNodeId add_open(double lower, double stop, float depth) {
        return add({lower < stop ? lower : stop, stop, 0, 0, kStop, depth, 0, 0, false, false});
    }

    // Give an open node its decisions.
    void expand(PolicyNodeId node, std::span<const DraftDecision> decisions);

    auto decisions_of(PolicyNodeId node) const {
        const Node& found = nodes_[node];
        return ids_between<DecisionId>(found.first, found.first + found.count);
    }
    std::span<const PolicyNodeId> successors(DecisionId decision) const {
        const auto [begin, size] = bounds(decision);
        return {successors_.data() + begin, size};
    }
    std::span<const double> weights(DecisionId decision) const {
        const auto [begin, size] = bounds(decision);
        return {weights_.data() + begin, size};
    }
    // The place of a decision's first outcome among those of all decisions; a node's decisions follow each other.
    std::size_t first_outcome(DecisionId decision) const { return bounds(decision).first; }
    double constant(DecisionId decision) const { return constants_[decision]; }
    double cost(DecisionId decision) const { return costs_[decision]; }

private:
    PolicyNodeId add(const Node& node) {
        nodes_.push_back(node);
        return PolicyNodeId(nodes_.size() - 1);
    }
    std::pair<std::size_t, std::size_t> bounds(DecisionId decision) const {
        assert(decision < ends_.size());
        const std::size_t begin = decision == 0 ? 0 : ends_[decision - 1];
        return {begin, ends_[decision] - begin};
    }

    SegmentedArray<Node> nodes_;
    FlatArray<std::uint32_t> ends_;  // by decision, in the arrays by outcome
    FlatArray<double> constants_;
    FlatArray<double> costs_;
    FlatArray<PolicyNodeId> successors_;  // by outcome
    FlatArray<double> weights_;
};

}  // namespace relax

#endif
