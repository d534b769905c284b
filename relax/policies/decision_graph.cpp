#include "relax/policies/decision_graph.hpp"

namespace relax {

void DecisionGraph::expand(PolicyNodeId node, std::span<const DraftDecision> decisions) {
    Node& expanded = nodes_[node];
    assert(!expanded.is_expanded);
    expanded.first = static_cast<std::uint32_t>(ends_.size());
    for (const DraftDecision& decision : decisions) {
        assert(decision.successors.size() == decision.weights.size());
        successors_.append(decision.successors.begin(), decision.successors.end());
        weights_.append(decision.weights.begin(), decision.weights.end());
        ends_.push_back(static_cast<std::uint32_t>(successors_.size()));
        constants_.push_back(decision.constant);
        costs_.push_back(decision.cost);
    }
    expanded.count = static_cast<std::uint32_t>(decisions.size());
    expanded.is_expanded = true;
}

}  // namespace relax
