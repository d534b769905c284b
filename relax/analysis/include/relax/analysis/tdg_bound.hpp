#ifndef RELAX_ANALYSIS_TDG_BOUND_HPP
#define RELAX_ANALYSIS_TDG_BOUND_HPP

#include <span>
#include <vector>

#include "relax/base/cost.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// The decomposition-graph bound: by TaskId, the least cost of the actions of any finite decomposition, states ignored;
// `kInfinity` where there is none. It is the value that the paper's Algorithms 1 and 2 mean (the best decomposition
// without a repeated task on a path), as the fixed point that Knuth's generalisation of Dijkstra's algorithm finds
// (1977). Throws Stopped.
//
// Exact: costs are not negative, so that a method's sum is at least each of its subtasks' values, and replacing the
// decomposition of a task by that of the same task further down makes no plan more expensive. Hence tasks become final
// in the order of their values. A lower bound of what a network costs: each of its tasks is decomposed by itself, and
// an action costs at least its own price in every state.
std::vector<Cost> tdg_bound(const GroundProblem& problem, std::span<const Cost> costs, Limits& limits);

}  // namespace relax

#endif
