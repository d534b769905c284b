#ifndef RELAX_SEARCH_LEARN_BRANCHING_HPP
#define RELAX_SEARCH_LEARN_BRANCHING_HPP

#include <span>

#include "relax/progression/branching.hpp"
#include "relax/search/search_space.hpp"

namespace relax {

// Tell the statistics of branching that a node has been expanded: which method has led to it, forced steps left aside,
// and which task its successors decompose.
void learn_branching(Branching& branching, const GroundProblem& problem, const SearchSpace& nodes, NodeId expanded,
                     std::span<const Successor> successors);

}  // namespace relax

#endif
