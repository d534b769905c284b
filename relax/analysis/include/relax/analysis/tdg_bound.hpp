#ifndef RELAX_ANALYSIS_TDG_BOUND_HPP
#define RELAX_ANALYSIS_TDG_BOUND_HPP

#include <span>
#include <vector>

#include "relax/base/cost.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// The decomposition-graph bound: by TaskId, the least cost of the actions of any finite decomposition, states ignored.
// It is the least fixed point of the paper's Algorithms 1 and 2 (best decomposition without a repeated task on a path),
// found by Knuth's generalisation of Dijkstra's algorithm (1977). `kInfinity` where there is no finite
// decomposition. Throws Stopped.
std::vector<Cost> tdg_bound(const GroundProblem& problem, std::span<const Cost> costs, Limits& limits);

}  // namespace relax

#endif
