#ifndef RELAX_POLICIES_DECISION_SOURCE_HPP
#define RELAX_POLICIES_DECISION_SOURCE_HPP

#include <vector>

#include "relax/policies/decision_graph.hpp"

namespace relax {

// Where the nodes of a decision graph come from. All of it may throw Stopped, and then leaves the graph as it was, but
// for open nodes that were added.
class DecisionSource {
public:
    virtual ~DecisionSource() = default;

    // Add the node to begin with, and return it.
    virtual PolicyNodeId add_root(DecisionGraph& graph) = 0;
    // Replace the content of `decisions` by those of an open node; successors that are new are added to the graph.
    virtual void decide(DecisionGraph& graph, PolicyNodeId node, std::vector<DraftDecision>& decisions) = 0;
    // Look closer at an open node: what it is worth at least, perhaps more than was known so far.
    virtual double bound(PolicyNodeId node, double known) = 0;
};

}  // namespace relax

#endif
