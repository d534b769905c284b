#ifndef RELAX_GROUNDING_CASES_HPP
#define RELAX_GROUNDING_CASES_HPP

#include <cstdint>
#include <vector>

#include "literals.hpp"
#include "reachability.hpp"
#include "task_graph.hpp"

namespace relax::grounding {

using CaseId = std::uint32_t;

// Thrown where an instance of an action falls into too many cases.
struct TooManyCases {
    std::uint32_t action;
    TupleId instance;
};

// The living actions in cases: each has a conjunction as its precondition. The
// cases of an instance share its effects and the parts of its cost.
struct Cases {
    std::vector<CaseId> begin;  // by action node; one more entry than there are action nodes
    std::vector<NodeId> owner;  // by CaseId
    Rows<Literal> condition;
    std::vector<std::uint32_t> effect_begin;  // by action node, likewise
    std::vector<NodeId> effect_owner;
    Rows<Literal> effect_condition;
    Rows<Literal> effect_changes;  // what becomes true; never a literal and its negation
    std::vector<bool> is_alive;    // by CaseId
    std::vector<bool> is_effect_alive;
    std::vector<std::uint32_t> cost_begin;              // by action node, likewise: parts of its cost
    Rows<std::uint32_t> cost_blocks;                    // by part: as GroundProblem::action_cost_blocks
    std::vector<std::uint32_t> cost_alternative_begin;  // by part; one more entry
    Rows<Literal> cost_condition;                       // by alternative: one of them makes the part due
};

// Bring the living actions into normal form. Throws TooManyCases.
Cases make_cases(const Knowledge& knowledge, const Expander& expander, const TaskGraph& graph,
                 const Dependents& dependents, Limits& limits);

}  // namespace relax::grounding

#endif
