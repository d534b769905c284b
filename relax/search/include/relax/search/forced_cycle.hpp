#ifndef RELAX_SEARCH_FORCED_CYCLE_HPP
#define RELAX_SEARCH_FORCED_CYCLE_HPP

#include <vector>

#include "relax/progression/progression.hpp"
#include "relax/search/search_space.hpp"

namespace relax {

// Tells where forced steps lead in a cycle: recursion without an alternative, such as a task whose only live method
// begins with the task itself.
//
// Let A be the only unconstrained task of the network of a node a, and R the rest, all of it ordered after A. Suppose
// that forced steps lead from a to a node b with the same state (as far as A reads it), where again A is the only
// unconstrained task, and that no network between has fewer tasks than that of a. Then A has not been accomplished
// between, R has not been touched, and the A of b is part of what the A of a has become. Suppose that A can be
// accomplished from this state, and take the fewest steps that do. A forced step keeps a plan, with the same steps in
// another order at most: so these begin with the forced ones, and after them accomplish the A of b, from the same state
// and in fewer steps, which is a contradiction. Hence both nodes are dead ends.
class ForcedCycle {
public:
    // Whether the last forced steps to the node are such a cycle, of 64 steps at most.
    bool closes(const SearchSpace& nodes, const TaskNetworks& networks, NodeId node);

private:
    // The unconstrained task, if it is the only one.
    std::optional<TaskId> first(const TaskNetworks& networks, NetworkId network);

    std::vector<Occurrence> unconstrained_;
};

}  // namespace relax

#endif
