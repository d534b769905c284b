#ifndef RELAX_ANALYSIS_COST_CASES_HPP
#define RELAX_ANALYSIS_COST_CASES_HPP

#include <span>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// Facts on which a cost part depends, with repetitions.
void append_cost_facts(const GroundProblem& problem, CostPartId part, std::vector<FactId>& positive,
                       std::vector<FactId>& negative);

// The parts of an action's cost in groups that have no fact in common, each in order: which parts of one group are due
// says nothing of those of another.
std::vector<std::vector<CostPartId>> unrelated_cost_groups(const GroundProblem& problem, ActionId action);

// Which parts of a group may be due together where the action is executed, without those cases that include all parts
// of another one: in each state that its preconditions allow, reachable or not, all parts of some case are due, and
// maybe more. Where the group depends on many facts this is not worked out, and there is one case, without any part.
std::vector<std::vector<CostPartId>> least_cost_cases(const GroundProblem& problem, ActionId action,
                                                      std::span<const CostPartId> group);

}  // namespace relax

#endif
