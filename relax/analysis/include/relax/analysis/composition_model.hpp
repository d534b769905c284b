#ifndef RELAX_ANALYSIS_COMPOSITION_MODEL_HPP
#define RELAX_ANALYSIS_COMPOSITION_MODEL_HPP

#include "relax/analysis/prices.hpp"
#include "relax/analysis/relaxed_model.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// The composition model (buildRCModel of the paper's Algorithm 5). Facts: one that always holds; the state's facts;
// for facts that something reads negatively, their complements; and for every task the fact that it has been reached.
// An action makes its effects true and its task reached; it needs its preconditions. A method needs its distinct
// subtasks reached, makes its task reached, and is free. Only what is reachable from a node's network takes part.
//
// Admissible: follow a plan. Whatever holds before one of its actions is reached by the operators of earlier ones, so
// that the action's operators can be applied; after the last one, its tasks are reached bottom-up by its methods. This
// pays the owners (see relaxed_model.hpp) that the plan pays, each no more often.
//
// Throws Stopped.
RelaxedModel composition_model(const GroundProblem& problem, const Prices& prices, Limits& limits);

}  // namespace relax

#endif
