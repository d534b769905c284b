#ifndef RELAX_ANALYSIS_DECOMPOSITION_MODEL_HPP
#define RELAX_ANALYSIS_DECOMPOSITION_MODEL_HPP

#include <span>

#include "relax/analysis/relaxed_model.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// The decomposition model, for what a plan costs beyond the bounds of its network's tasks. It keeps more of the
// hierarchy than the composition model: what is executed has been asked for, in time. For every task there is one more
// fact, that it may start, and for every method that costs something, that it has been entered. An action needs that
// its task may start. Entering a method needs that its task may start, and costs; it lets those subtasks start that
// nothing is ordered before; the others start when those before them have been reached. The method then makes its task
// reached when it has been entered and all subtasks have been reached.
//
// Every method costs its slack, the sum of its subtasks' bounds less its task's, and of an action only the cost parts
// cost something. Replacing a task by the subtasks of a method raises the sum of the bounds by the slack, until only
// actions are left; so a plan costs the sum of its network's bounds, the slacks of the methods that it uses and the
// cost parts that are due.
//
// Admissible, with a fact per task, under order. Follow a plan and its decomposition, each method entered just before
// what is below it begins. By induction, whenever a task's turn has come in the plan, the fact that it may start has
// been reached, since all tasks ordered before it have ended; and when it has ended, the fact that it has been reached.
// Where a task occurs twice, these facts hold for the later occurrence as soon as they do for the earlier one: the
// model may start and end it too early, which allows more than the plan does and excludes nothing. The owners (see
// relaxed_model.hpp) that pay for this are methods that were entered and parts that were due, each paid no more often
// than in the plan.
//
// `task_bounds`: by TaskId, see `tdg_bound`. Throws Stopped.
RelaxedModel decomposition_model(const GroundProblem& problem, std::span<const Cost> task_bounds,
                                 std::span<const Cost> part_prices, Limits& limits);

}  // namespace relax

#endif
