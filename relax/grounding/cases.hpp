#ifndef RELAX_GROUNDING_CASES_HPP
#define RELAX_GROUNDING_CASES_HPP

#include <cstdint>
#include <vector>

#include "literals.hpp"
#include "reachability.hpp"
#include "relax/base/rows.hpp"
#include "task_graph.hpp"

namespace relax::grounding {

using CaseId = std::uint32_t;
using BranchId = Id<struct BranchTag>;

// Thrown where an instance of an action falls into too many cases, or has too many outcomes.
struct TooManyCases {
    std::uint32_t action;
    TupleId instance;
    bool is_about_outcomes = false;
};

// The living actions in cases: each has a conjunction as its precondition. The
// cases of an instance share its effects and the parts of its cost, those of all
// its outcomes.
struct Cases {
    static constexpr BranchId kCertain{0};

    Shares<NodeId, CaseId> cases;  // by action node, as are their effects and the parts of their costs
    std::vector<NodeId> owner;     // by CaseId
    Rows<Literal> condition;
    Shares<NodeId, EffectId> effects;
    std::vector<NodeId> effect_owner;
    Rows<Literal> effect_condition;
    Rows<Literal> effect_changes;  // what becomes true; never a literal and its negation
    std::vector<BranchId> effect_branch;
    std::vector<bool> is_alive;  // by CaseId
    std::vector<bool> is_effect_alive;
    Shares<NodeId, CostPartId> cost_parts;
    Rows<std::uint32_t> cost_blocks;  // by part: as GroundProblem::action_cost_blocks
    std::vector<BranchId> cost_branch;
    Shares<CostPartId, AlternativeId> cost_alternatives;
    Rows<Literal> cost_condition;  // by alternative: one of them makes the part due
    // Branches of outcomes that change or cost something; `kCertain`: what is so whatever nature chooses.
    std::vector<LiftedBranch> branches;
    Rows<ObjectId, BranchId> branch_objects;  // of the variables of its block
};

// Bring the living actions into normal form. Throws TooManyCases.
Cases make_cases(const Knowledge& knowledge, const Expander& expander, const TaskGraph& graph,
                 const Dependents& dependents, Limits& limits);

}  // namespace relax::grounding

#endif
