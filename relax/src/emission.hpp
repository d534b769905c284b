#ifndef RELAX_EMISSION_HPP
#define RELAX_EMISSION_HPP

#include <vector>

#include "cases.hpp"
#include "pruning.hpp"
#include "reachability.hpp"
#include "relax/ground_problem.hpp"

namespace relax {

// Number what is left and lay it out in flat arrays; literals that are certain and facts that nothing reads vanish.
GroundProblem emit(const Reachability& reachability, const CaseBuilder& facts, std::vector<ActionCase> cases,
                   const Pruned& pruned);

}  // namespace relax

#endif
