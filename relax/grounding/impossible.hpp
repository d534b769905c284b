#ifndef RELAX_GROUNDING_IMPOSSIBLE_HPP
#define RELAX_GROUNDING_IMPOSSIBLE_HPP

#include <memory>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/base/limits.hpp"

namespace relax::grounding {

// Find the problem's mutexes, keep them with it, and leave out actions whose preconditions never hold together, then
// tasks without a decomposition into what is left, and what the initial task does not lead to. No plan is lost: it
// executes all of its actions, each in a state that can be reached, and all of its tasks are decomposed. If the
// initial task is left out, the result is not solvable, and nothing else of it means anything. Throws Stopped.
std::unique_ptr<AnalysedProblem> without_impossible(GroundProblem problem, Limits& limits);

}  // namespace relax::grounding

#endif
