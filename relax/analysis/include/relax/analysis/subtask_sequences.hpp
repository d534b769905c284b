#ifndef RELAX_ANALYSIS_SUBTASK_SEQUENCES_HPP
#define RELAX_ANALYSIS_SUBTASK_SEQUENCES_HPP

#include <cstdint>

#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/rows.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// By MethodId: its subtasks by index, in their order; where they have none, in that of the domain. Throws Stopped.
Rows<std::uint32_t> subtask_sequences(const GroundProblem& problem, Limits& limits);

}  // namespace relax

#endif
