#ifndef RELAX_GROUNDER_HPP
#define RELAX_GROUNDER_HPP

#include <cstdint>
#include <variant>
#include <vector>

#include "relax/ground_problem.hpp"
#include "relax/ids.hpp"
#include "relax/lifted_problem.hpp"
#include "relax/limits.hpp"

namespace relax {

// An action whose precondition or cost falls into too many cases.
struct TooManyCasesOf {
    std::uint32_t action;
    std::vector<ObjectId> arguments;
};

// Instantiate what the initial task can lead to, and what can be reached, of a lifted problem. Numbering depends on the
// problem alone.
std::variant<GroundProblem, StopReason, TooManyCasesOf> ground(const LiftedProblem& problem, Limits& limits);

}  // namespace relax

#endif
