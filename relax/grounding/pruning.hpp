#ifndef RELAX_GROUNDING_PRUNING_HPP
#define RELAX_GROUNDING_PRUNING_HPP

#include <vector>

#include "cases.hpp"
#include "task_graph.hpp"

namespace relax::grounding {

// Drop actions (cases) and effects that relaxed reachability does not reach, tasks without a decomposition into what is
// left, and what the initial task does not lead to, until nothing changes. In the relaxation a literal (a fact or its
// negation) that was true once stays so.
//
// No plan is lost: everything that a plan executes is reached in the relaxation, its decomposition is finite, and the
// initial task leads to all of it; so nothing of it is dropped in the first round, nor in any later one, where still
// everything of it is there.
//
// `is_initially_true`: by fact. Returns by Literal whether it can be true; meaningless where the initial task has been
// dropped.
std::vector<bool> prune(TaskGraph& graph, Cases& cases, const std::vector<bool>& is_initially_true, Limits& limits);

}  // namespace relax::grounding

#endif
