#ifndef RELAX_SRC_GROUNDER_CASES_HPP
#define RELAX_SRC_GROUNDER_CASES_HPP

#include <cstdint>
#include <vector>

#include "grounder_literals.hpp"
#include "grounder_reachability.hpp"
#include "grounder_task_graph.hpp"

namespace relax::grounding {

using CaseId = std::uint32_t;

// Thrown where an instance of an action falls into too many cases.
struct TooManyCases {
    std::uint32_t action;
    TupleId instance;
};

// The living actions in cases: each has a conjunction as its precondition and
// one cost law. The cases of an instance share its effects.
struct Cases {
    std::vector<CaseId> begin;  // by action node; one more entry than there are action nodes
    std::vector<NodeId> owner;  // by CaseId
    Rows<Literal> condition;
    Rows<std::uint32_t> cost_parts;           // as GroundProblem::action_cost_parts
    std::vector<std::uint32_t> effect_begin;  // by action node, likewise
    std::vector<NodeId> effect_owner;
    Rows<Literal> effect_condition;
    Rows<Literal> effect_changes;  // what becomes true; never a literal and its negation
    std::vector<bool> is_alive;    // by CaseId
    std::vector<bool> is_effect_alive;
};

// Bring the living actions into normal form. Throws TooManyCases.
Cases make_cases(const Knowledge& knowledge, const Expander& expander, const TaskGraph& graph,
                 const Dependents& dependents, Limits& limits);

}  // namespace relax::grounding

#endif
