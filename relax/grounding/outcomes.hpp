#ifndef RELAX_GROUNDING_OUTCOMES_HPP
#define RELAX_GROUNDING_OUTCOMES_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "assembly.hpp"

namespace relax::grounding {

// One of the outcomes of an action in a case of its precondition: what it changes and costs.
struct RemainingOutcome {
    std::vector<std::uint32_t> branches;  // as GroundProblem::action_branches
    Effects effects;
    Costs costs;
};

// The outcomes of a case; one for an action without branches.
//
// Nature chooses a branch of each instance of a block of outcomes. An instance of which no branch costs anything, or
// changes a fact that is numbered (as it is if something reads it), makes no difference and is left out. Combinations
// of branches that change the same become one outcome, where what the branches cost has no conditions; its cost is the
// mixture of theirs. What an only outcome changes and costs is moved there from the case. Throws Stopped, and nothing
// where there are more than 64 outcomes with different changes, or very many combinations.
std::optional<std::vector<RemainingOutcome>> outcomes_of(const Remains& remains, const LiftedAction& action,
                                                         RemainingCase& one,
                                                         const std::vector<std::optional<FactId>>& number_of_fact);

// Append an outcome with the precondition of its case, facts numbered by `number_of_fact`.
void write_action(const Conjunction& precondition, const RemainingOutcome& outcome,
                  const std::vector<std::optional<FactId>>& number_of_fact, GroundProblem& problem);

}  // namespace relax::grounding

#endif
