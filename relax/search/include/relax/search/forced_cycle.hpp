#ifndef RELAX_SEARCH_FORCED_CYCLE_HPP
#define RELAX_SEARCH_FORCED_CYCLE_HPP

#include <vector>

#include "relax/progression/progression.hpp"
#include "relax/search/search_space.hpp"

namespace relax {

// Tells where forced steps lead in a circle: recursion without another way, such as a task whose only live method
// begins with the task itself.
//
// Let A be the only unconstrained task of the network of a node a, R the rest, all of it ordered after A. As long as
// each step is forced and a single task is unconstrained, the steps depend on that task and on the state, as far as
// the task reads it, alone. Suppose they lead from a, no network on the way being smaller than A R, to a node b that
// has a's state, where A is again all that is unconstrained. R has not been touched, so the A of b is part of what the
// A of a has become. Take the fewest steps that accomplish A from this state, on whatever way. They begin with the
// forced ones, and then accomplish the inner A from the same state in fewer steps: a contradiction. So there are none,
// and both nodes are dead ends.
class ForcedCycle {
public:
    // Whether the last forced steps to the node are such a circle; only a few steps are looked back upon.
    bool closes(const SearchSpace& nodes, const TaskNetworks& networks, NodeId node);

private:
    // The unconstrained task, if it is the only one.
    std::optional<TaskId> first(const TaskNetworks& networks, NetworkId network);

    std::vector<Occurrence> unconstrained_;
};

}  // namespace relax

#endif
