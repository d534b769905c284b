#ifndef RELAX_ANALYSIS_COST_SHIFTING_HPP
#define RELAX_ANALYSIS_COST_SHIFTING_HPP

#include "relax/analysis/prices.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// Prices for lower bounds, which look at actions without a state: as much as possible of the prices of cost parts is
// moved to the prices of their actions (cost shifting, as in weighted constraint satisfaction: Schiex 2000).
//
// Take several parts of an action of which one at least is due in every state, as with a condition and its negation.
// The least of their prices is subtracted from each of them and added to the price of the action. In a state in which
// k >= 1 of them are due, the action then costs k - 1 times that amount less than before: no action costs more in any
// state, so that a lower bound of the shifted costs is one of the costs; and where exactly one is due in each state,
// nothing is lost. "Every state" means every truth of facts, reachable or not, so that the test is a small
// satisfiability problem; one that takes too long counts as not shown. Throws Stopped.
Prices shift_costs(const GroundProblem& problem, Prices prices, Limits& limits);

}  // namespace relax

#endif
