#ifndef RELAX_GROUND_PROBLEM_HPP
#define RELAX_GROUND_PROBLEM_HPP

// The ground problem: flat, immutable arrays, the only thing that heuristics and search read.
//
// Every action has one cost law and a precondition without disjunctions. An action of the domain for which that
// is not so stands here once for each case, and a compound task of the same schema and arguments (a "choice")
// has one method for each of them.

#include <cstdint>
#include <utility>
#include <vector>

#include "relax/ids.hpp"

namespace relax {

struct GroundProblem {
    // By FactId. Only facts that can change and that something reads or that the initial state holds.
    std::vector<std::uint32_t> fact_predicate;
    Rows<ObjectId> fact_arguments;

    // By ActionId.
    Rows<FactId> preconditions;
    Rows<FactId> negative_preconditions;
    std::vector<EffectId>
        effect_begin;  // one more entry than there are actions: effects of `a` are [begin[a], begin[a + 1])
    std::vector<std::uint32_t> action_schema;
    Rows<ObjectId> action_arguments;
    // Which conditional parts of the cost are due: records of the part's number, the number of its variables, their
    // objects.
    Rows<std::uint32_t> action_cost_parts;

    // By EffectId. Conditions are read in the state before the action; adding wins over deleting, also across effects.
    Rows<FactId> effect_conditions;
    Rows<FactId> effect_negative_conditions;
    Rows<FactId> effect_adds;
    Rows<FactId> effect_deletes;

    // By compound task: index 0 is task number action_count().
    std::vector<std::uint32_t> compound_schema;  // as in LiftedSubtask::task: an action's number for a choice
    Rows<ObjectId> compound_arguments;
    Rows<MethodId> compound_methods;

    // By MethodId.
    std::vector<TaskId> method_task;
    // Its parts are [begin[m], begin[m + 1]): lifted methods that were applied at once, its own first, since the tasks
    // that the others decompose have no other method. A method of a choice has none.
    std::vector<std::uint32_t> method_part_begin;
    Rows<TaskId> method_subtasks;
    // Of each subtask: the part that it belongs to, counted from the method's first, and its index in that lifted
    // method.
    Rows<std::pair<std::uint32_t, std::uint32_t>> method_positions;
    Rows<std::pair<std::uint32_t, std::uint32_t>>
        method_ordering;  // indices into the subtasks; transitively closed, sorted

    // By part: the lifted method; the part whose subtask it decomposes, counted from the method's first, and the index
    // of that subtask in the lifted method.
    std::vector<std::uint32_t> part_schema;
    Rows<ObjectId> part_arguments;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> part_origin;

    std::vector<FactId> initial_state;  // sorted
    TaskId initial_task = 0;
    bool solvable =
        true;  // false: grounding proved that the initial task cannot be accomplished; the rest is then empty

    std::size_t fact_count() const { return fact_predicate.size(); }
    std::size_t action_count() const { return action_schema.size(); }
    std::size_t compound_count() const { return compound_schema.size(); }
    std::size_t task_count() const { return action_count() + compound_count(); }
    std::size_t method_count() const { return method_task.size(); }
    bool is_primitive(TaskId task) const { return task < action_count(); }
    std::span<const MethodId> methods_of(TaskId task) const { return compound_methods[task - action_count()]; }
};

}  // namespace relax

#endif
