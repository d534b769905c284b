#ifndef RELAX_VALUATIONS_LEAST_LAWS_HPP
#define RELAX_VALUATIONS_LEAST_LAWS_HPP

#include <span>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/ground_problem.hpp"
#include "relax/valuations/law_table.hpp"

namespace relax {

// By ActionId: a law that what the action costs is stochastically at least, in whatever state it is executed. What is
// always due has a law of `always`. Of the parts that are due on a condition, by CostPartId, all of some case are due
// (see `least_cost_cases`), so that together they cost stochastically at least the highest law over all cases. Given
// the state, groups of parts are independent costs and add up. Throws Stopped.
std::vector<LawId> least_laws(const GroundProblem& problem, std::vector<LawId> always, std::span<const LawId> parts,
                              LawTable& table, Limits& limits);

}  // namespace relax

#endif
