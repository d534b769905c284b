#ifndef RELAX_PROBLEM_GROUND_PROBLEM_HPP
#define RELAX_PROBLEM_GROUND_PROBLEM_HPP

// The ground problem: flat, immutable arrays, the only thing that heuristics and search read.
//
// Every action has a precondition without disjunctions. An action of the domain for which that is not so stands here
// once for each case, and a compound task of the same schema and arguments (a "choice") has one method for each of
// them.
//
// An action with several outcomes stands here once for each of them, and a compound task of the same schema and
// arguments (a "chance task") has one method for each of these *outcome actions*: they have the same precondition, and
// each changes and costs what is certain and what belongs to its outcome. So this problem is deterministic; where it is
// nature that chooses the methods of chance tasks, it is the problem with outcomes, and where the agent does, it is its
// all-outcomes determinisation.
//
// The cost of an action is the sum of independent parts: those that are always due, and its *cost parts*, each of which
// is due, once, where a condition holds in the state before the action. Risk costs of independent parts add up.

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <utility>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/rows.hpp"

namespace relax {

struct GroundProblem {
    // Rows of facts are sorted and have no repetitions.
    //
    // By FactId. Only facts that can change and that something reads or that the initial state holds.
    std::vector<std::uint32_t> fact_predicate;
    Rows<ObjectId, FactId> fact_arguments;

    // By ActionId.
    Rows<FactId, ActionId> preconditions;
    Rows<FactId, ActionId> negative_preconditions;
    Shares<ActionId, EffectId> effects;
    std::vector<std::uint32_t> action_schema;
    Rows<ObjectId, ActionId> action_arguments;
    // Blocks of the cost with a condition or variables that are due wherever the action can be executed: records of the
    // block's number, the number of its variables, their objects.
    Rows<std::uint32_t, ActionId> action_cost_blocks;
    Shares<ActionId, CostPartId> cost_parts;
    // What nature chooses where the action comes of it: one of several combinations of branches, each the number of its
    // records, then these: the number of a block of outcomes, the branch, the number of the block's variables, their
    // objects. The combinations of a chance task's actions exclude each other. Empty for an action of one outcome.
    Rows<std::uint32_t, ActionId> action_branches;

    // By CostPartId. The condition is that one of its alternatives holds.
    Rows<std::uint32_t, CostPartId> cost_part_blocks;  // what is due then, as in `action_cost_blocks`
    Shares<CostPartId, AlternativeId> cost_alternatives;
    // By AlternativeId: all of these facts hold, none of those. Never empty, both of them.
    Rows<FactId, AlternativeId> cost_conditions;
    Rows<FactId, AlternativeId> cost_negative_conditions;

    // By EffectId. Conditions are read in the state before the action; adding wins over deleting, also across effects.
    Rows<FactId, EffectId> effect_conditions;
    Rows<FactId, EffectId> effect_negative_conditions;
    Rows<FactId, EffectId> effect_adds;
    Rows<FactId, EffectId> effect_deletes;

    // By compound task: index 0 is task number action_count().
    // As in LiftedSubtask::task; an action's number for a choice and for a chance task.
    std::vector<std::uint32_t> compound_schema;
    Rows<ObjectId> compound_arguments;
    Rows<MethodId> compound_methods;
    std::vector<bool> compound_is_chance;  // nature chooses the method, which is one outcome action

    // By MethodId.
    std::vector<TaskId> method_task;
    // Lifted methods that were applied at once, its own first, since the tasks that the others decompose have no other
    // method. A method of a choice has none, nor has one of a chance task.
    Shares<MethodId, PartId> method_parts;
    Rows<TaskId, MethodId> method_subtasks;
    // Of each subtask: the part that it belongs to, counted from the method's first, and its index in that lifted
    // method.
    Rows<std::pair<std::uint32_t, std::uint32_t>, MethodId> method_positions;
    // Pairs of indices into the subtasks; transitively closed, sorted.
    Rows<std::pair<std::uint32_t, std::uint32_t>, MethodId> method_ordering;

    // By PartId: the lifted method; the part whose subtask it decomposes, counted from the method's first, and the
    // index of that subtask in the lifted method.
    std::vector<std::uint32_t> part_schema;
    Rows<ObjectId, PartId> part_arguments;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> part_origin;

    std::vector<FactId> initial_state;  // sorted
    TaskId initial_task;
    // False: grounding proved that the initial task cannot be accomplished; the rest is then empty.
    bool solvable = true;

    std::size_t fact_count() const { return fact_predicate.size(); }
    std::size_t action_count() const { return action_schema.size(); }
    std::size_t compound_count() const { return compound_schema.size(); }
    std::size_t task_count() const { return action_count() + compound_count(); }
    std::size_t method_count() const { return method_task.size(); }
    std::size_t cost_part_count() const { return cost_part_blocks.size(); }
    auto facts() const { return all_ids<FactId>(fact_count()); }
    auto actions() const { return all_ids<ActionId>(action_count()); }
    auto tasks() const { return all_ids<TaskId>(task_count()); }
    auto compounds() const {
        return ids_between<TaskId>(static_cast<std::uint32_t>(action_count()),
                                   static_cast<std::uint32_t>(task_count()));
    }
    auto methods() const { return all_ids<MethodId>(method_count()); }
    // An effect that has no condition happens whenever its action is executed.
    bool is_unconditional(EffectId effect) const {
        return effect_conditions[effect].empty() && effect_negative_conditions[effect].empty();
    }
    bool is_primitive(TaskId task) const {
        assert(task < task_count());
        return task < action_count();
    }
    // Of a primitive task.
    ActionId action_of(TaskId task) const {
        assert(is_primitive(task));
        return ActionId(std::uint32_t{task});
    }
    // Whether nature chooses among the task's methods.
    bool is_chance(TaskId task) const { return !is_primitive(task) && compound_is_chance[task - action_count()]; }
    bool has_outcomes() const { return std::ranges::find(compound_is_chance, true) != compound_is_chance.end(); }
    // Of a method of a chance task: its outcome action.
    ActionId outcome_action(MethodId method) const { return action_of(method_subtasks[method].front()); }
    // Of an action or a chance task: itself, or one of its outcome actions. They have the same precondition.
    ActionId any_outcome(TaskId task) const {
        return is_primitive(task) ? action_of(task) : outcome_action(methods_of(task).front());
    }
    // Of a compound task.
    std::span<const MethodId> methods_of(TaskId task) const {
        assert(!is_primitive(task));
        return compound_methods[task - action_count()];
    }
};

}  // namespace relax

#endif
