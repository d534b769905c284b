#ifndef RELAX_GROUNDING_GROUNDER_HPP
#define RELAX_GROUNDING_GROUNDER_HPP

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/lifted_problem.hpp"

namespace relax {

// An action whose precondition or cost falls into too many cases, or one with too many outcomes.
struct TooManyCasesOf {
    std::uint32_t action;
    std::vector<ObjectId> arguments;
    bool is_about_outcomes;
};

// Refinements that keep the set of plans.
struct GroundingOptions {
    // Let equal tests be one action, and equal methods of a task one method.
    bool merge_equal = true;
    // Replace tasks of a single method by its subtasks, where that does not copy much.
    bool replace_single_methods = true;
    // Leave out actions that pairs of facts tell never to be executed, and what is of no use without them.
    bool ask_mutexes = true;
};

// Instantiate what the initial task can lead to, and what can be reached, of a lifted problem. Numbering depends on the
// problem alone.
std::variant<std::unique_ptr<AnalysedProblem>, StopReason, TooManyCasesOf> ground(const LiftedProblem& problem,
                                                                                  const GroundingOptions& options,
                                                                                  Limits& limits);

}  // namespace relax

#endif
