#ifndef RELAX_PROGRESSION_OPEN_PRECONDITIONS_HPP
#define RELAX_PROGRESSION_OPEN_PRECONDITIONS_HPP

#include <cstdint>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/analysis/task_profiles.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/networks/ordered_tasks.hpp"
#include "relax/problem/state.hpp"

namespace relax {

// A test on task networks, without a state, that proves that no decomposition of them can be executed: a precondition
// of a primitive task t that nothing can make true in time. What could is the initial state, or a task that is not
// ordered after t and may have the effect, itself or by its decompositions; unless an action that is ordered between it
// and t makes the precondition false in every state. (Open preconditions, causal links and threats, as in partial-order
// causal-link planning.)
class OpenPreconditions {
public:
    OpenPreconditions(const AnalysedProblem& problem, Limits& limits)
        : problem_(problem), limits_(limits), initial_state_(StateTransition(problem).initial_state()) {}

    // False only if the network has no executable decomposition. Throws Stopped.
    bool can_be_met(const OrderedTasks& network);

private:
    bool can_be_met(const OrderedTasks& network, std::size_t task, Literal literal);

    const AnalysedProblem& problem_;
    Limits& limits_;
    StateBits initial_state_;
    std::vector<const TaskProfile*> occurring_;  // by occurrence of the network looked at
    OrderedTasks successors_;                    // the order turned round, likewise
    std::vector<std::uint64_t> threats_;         // a row of it
};

}  // namespace relax

#endif
