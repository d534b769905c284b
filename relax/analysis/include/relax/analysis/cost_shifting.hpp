#ifndef RELAX_ANALYSIS_COST_SHIFTING_HPP
#define RELAX_ANALYSIS_COST_SHIFTING_HPP

#include "relax/analysis/prices.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// Prices for lower bounds, which look at actions without a state: as much as possible of the prices of cost parts is
// moved to the prices of their actions. (Cost shifting, as in weighted constraint satisfaction: Schiex 2000.)
//
// Where one of several parts of an action is due in every state, as with a condition and its negation, the least of
// their prices is taken off all of them and added to the price of the action. In a state in which k >= 1 of them are
// due, the action then costs k - 1 times that amount less than before, so that no action costs more in any state; and
// if exactly one of them is always due, it costs the same in all. Throws Stopped.
Prices shift_costs(const GroundProblem& problem, Prices prices, Limits& limits);

}  // namespace relax

#endif
