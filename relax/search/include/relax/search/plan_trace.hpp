#ifndef RELAX_SEARCH_PLAN_TRACE_HPP
#define RELAX_SEARCH_PLAN_TRACE_HPP

#include <span>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/limits.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/search_result.hpp"
#include "relax/search/search_space.hpp"

namespace relax {

// Write the plan that the steps lead to from the initial state and network, its cost and its decomposition tree. Where
// a limit is reached before that is done, the result has no plan, and says what stopped it.
void trace_steps(const PricedProblem& priced, TaskNetworks& networks, std::span<const SearchStep> steps, Limits& limits,
                 SearchResult& result);

// The same for the steps that lead to a node.
void trace_plan(const PricedProblem& priced, Progression& progression, const SearchSpace& nodes, NodeId goal,
                Limits& limits, SearchResult& result);

}  // namespace relax

#endif
