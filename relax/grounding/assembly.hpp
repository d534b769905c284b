#ifndef RELAX_GROUNDING_ASSEMBLY_HPP
#define RELAX_GROUNDING_ASSEMBLY_HPP

#include <map>
#include <optional>
#include <vector>

#include "cases.hpp"
#include "relax/base/limits.hpp"
#include "relax/grounding/grounder.hpp"
#include "relax/problem/ground_problem.hpp"
#include "task_graph.hpp"

namespace relax::grounding {

// What pruning has left, ready to be written down.
struct Remains {
    const Knowledge& knowledge;
    TaskGraph& graph;
    const Cases& cases;
    const std::vector<std::uint32_t>& fact_begin;  // by predicate
    const std::vector<bool>& is_initially_true;    // by fact
    const std::vector<bool>& is_literal_reached;
    const GroundingOptions& options;
    Limits& limits;
};

// Write the ground problem: literals that are always true vanish, and so do
// facts that nothing reads, precondition actions without a condition, and cases
// that another one contains.
GroundProblem assemble(const Remains& remains);

// Changes by condition: the unconditional ones come first.
using Effects = std::map<Conjunction, Conjunction>;

// Blocks of an action's cost (as GroundProblem::action_cost_blocks) by the condition on which they are due.
using Costs = std::map<Disjunction, std::vector<std::uint32_t>>;

// What a branch of an outcome changes and costs, both as they stand.
struct RemainingBranch {
    BranchId id;
    Effects effects;
    Costs costs;
};

// A case of an action, with what remains of its precondition, its effects and its cost: those that are certain, and
// those of the branches of its outcomes. Where there are any, effects that others make redundant are still there.
struct RemainingCase {
    CaseId number;
    Conjunction condition;
    Effects effects;
    Costs costs;
    std::vector<RemainingBranch> branches;  // by BranchId
};
// At least one.
std::vector<RemainingCase> remaining_cases(const Remains& remains, NodeId action);

// Facts of preconditions and of conditions of costs, and of conditions of effects on such facts.
// `is_written`: by action node.
std::vector<bool> read_facts(const Remains& remains, const std::vector<bool>& is_written);

// Drop effects that the precondition or other effects make redundant.
void tidy(Effects& effects, const Conjunction& precondition);

}  // namespace relax::grounding

#endif
