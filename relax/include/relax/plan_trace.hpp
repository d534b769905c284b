#ifndef RELAX_PLAN_TRACE_HPP
#define RELAX_PLAN_TRACE_HPP

#include <span>

#include "relax/ground_problem.hpp"
#include "relax/prices.hpp"
#include "relax/progression.hpp"
#include "relax/search_node.hpp"
#include "relax/search_result.hpp"

namespace relax {

// Write the plan that the steps lead to from the initial state and network, its cost and its decomposition tree.
void trace_steps(const GroundProblem& problem, const Prices& prices, Progression& progression,
                 std::span<const SearchStep> steps, SearchResult& result);

// The same for the steps that lead to a node.
void trace_plan(const GroundProblem& problem, const Prices& prices, Progression& progression,
                const DuplicateRegistry& nodes, NodeId goal, SearchResult& result);

}  // namespace relax

#endif
