#ifndef RELAX_POLICIES_EXPLICIT_SOURCE_HPP
#define RELAX_POLICIES_EXPLICIT_SOURCE_HPP

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "relax/policies/decision_source.hpp"

namespace relax {

// A decision graph that is given as a whole. Nodes have numbers of their own there.
struct ExplicitNode {
    bool is_done = false;
    double first_lower = 0;  // what is known of its worth when it is first met ...
    double lower = 0;        // ... and when it is looked at closer
    double stop = kNever;
    std::vector<DraftDecision> decisions;  // their successors are numbers here
};

class ExplicitSource : public DecisionSource {
public:
    // Throws std::out_of_range where a decision leads to no node.
    ExplicitSource(std::vector<ExplicitNode> nodes, std::uint32_t root);

    PolicyNodeId add_root(DecisionGraph& graph) override { return add(graph, root_); }
    void decide(DecisionGraph& graph, PolicyNodeId node, std::vector<DraftDecision>& decisions) override;
    double bound(PolicyNodeId node, double known) override;

    std::uint32_t number_of(PolicyNodeId node) const { return numbers_[node]; }

private:
    PolicyNodeId add(DecisionGraph& graph, std::uint32_t number);

    std::vector<ExplicitNode> nodes_;
    std::uint32_t root_;
    std::vector<std::optional<PolicyNodeId>> ids_;  // by number
    std::vector<std::uint32_t> numbers_;            // by node of the graph
};

}  // namespace relax

#endif
