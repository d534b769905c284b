#ifndef RELAX_ANALYSIS_RELAXED_MODEL_HPP
#define RELAX_ANALYSIS_RELAXED_MODEL_HPP

// Relaxed classical models of an HTN problem: operators that make facts true and never false. There are two: see
// composition_model.hpp and decomposition_model.hpp, which say why they are admissible.
//
// Effects with conditions become operators of their own. They share their action's cost: the action is the *owner*,
// whose cost a relaxed plan pays once.
//
// Parts of an action's cost that are due on a condition are settled one after the other, between the action's
// preconditions and its effects: a part by an operator that needs the condition and costs its price, or by a free one
// that needs the condition's negation. Each part is an owner. What the action does needs the last part settled. In the
// first execution of an action in a plan, each part can be settled as it was in the plan, since the facts of the state
// before are reached; later executions find it settled, and cost nothing more in the model. (The max heuristic, which
// adds up along a path, pays once for each execution on it, and so does the plan.)

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/rows.hpp"

namespace relax {

using RelaxedFact = std::uint32_t;
using OperatorId = std::uint32_t;
// Index space of costs: the actions, or the methods; then the cost parts, and one owner for all that is free.
using OwnerId = std::uint32_t;

struct RelaxedModel {
    static constexpr RelaxedFact kAlwaysTrue = 0;

    // By OperatorId.
    Rows<RelaxedFact, OperatorId> preconditions;  // never empty
    Rows<RelaxedFact, OperatorId> adds;
    std::vector<OwnerId> owner;
    // By RelaxedFact.
    Rows<OperatorId, RelaxedFact> precondition_of;
    Rows<OperatorId, RelaxedFact> achievers;
    // By OwnerId.
    std::vector<Cost> owner_cost;
    Rows<OperatorId> owner_operators;
    // Facts that are read negatively, and the complement of each.
    std::vector<std::pair<FactId, RelaxedFact>> complements;

    // Of the composition model alone. By TaskId: an action's operators, or a compound task's methods. By operator of a
    // method: its distinct subtasks.
    Rows<OperatorId, TaskId> task_operators;
    Rows<TaskId, OperatorId> operator_subtasks;
    std::vector<OperatorId> method_operator;  // by MethodId
    std::vector<TaskId> operator_task;        // by OperatorId: the action, or the task of the method
    RelaxedFact first_settled = 0;            // of the facts about cost parts, which come last

    RelaxedFact first_reached = 0;  // of the facts that tasks have been reached
    RelaxedFact first_start = 0;    // of the facts that tasks may start; none in the composition model
    std::size_t action_count = 0;   // of those that may start

    std::size_t fact_count() const { return precondition_of.size(); }
    std::size_t operator_count() const { return owner.size(); }
    RelaxedFact holds(FactId fact) const { return 1 + fact; }
    RelaxedFact reached(TaskId task) const { return first_reached + task; }
    // Of the decomposition model alone.
    RelaxedFact may_start(TaskId task) const { return first_start + task; }
    bool is_decomposition() const { return first_start != 0; }
    // The fact that an action may start: the only readers are the action's operators.
    bool starts_action(RelaxedFact fact) const { return fact - first_start < action_count; }
    // Of the composition model alone: an operator that only settles a part of an action's cost is no step of its own.
    bool is_step(OperatorId op) const { return adds[op].front() < first_settled; }
};

}  // namespace relax

#endif
