#ifndef RELAX_PROBLEM_GROUND_PROBLEM_HPP
#define RELAX_PROBLEM_GROUND_PROBLEM_HPP

// The ground problem: flat, immutable arrays, the only thing that heuristics and search read.
//
// Every action has a precondition without disjunctions. An action of the domain for which that is not so stands here
// once for each case, and a compound task of the same schema and arguments (a "choice") has one method for each of
// them.
//
// The cost of an action is the sum of independent parts: those that are always due, and its *cost parts*, each of which
// is due, once, where a condition holds in the state before the action. Risk costs of independent parts add up.

#include <cstdint>
#include <memory>
#include <ranges>
#include <utility>
#include <vector>

#include "relax/base/ids.hpp"

namespace relax {

class Mutexes;

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
    // Blocks of the cost with a condition or variables that are due wherever the action can be executed: records of the
    // block's number, the number of its variables, their objects.
    Rows<std::uint32_t> action_cost_blocks;
    std::vector<CostPartId> cost_part_begin;  // one more entry, likewise

    // By CostPartId. The condition is that one of its alternatives holds: [begin[p], begin[p + 1]).
    Rows<std::uint32_t> cost_part_blocks;  // what is due then, as in `action_cost_blocks`
    std::vector<std::uint32_t> cost_alternative_begin;
    // By alternative of a cost part: all of these facts hold, none of those. Never empty, both of them.
    Rows<FactId> cost_conditions;
    Rows<FactId> cost_negative_conditions;

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
    std::shared_ptr<const Mutexes> mutexes;  // none where nobody has looked for them
    bool solvable =
        true;  // false: grounding proved that the initial task cannot be accomplished; the rest is then empty

    std::size_t fact_count() const { return fact_predicate.size(); }
    std::size_t action_count() const { return action_schema.size(); }
    std::size_t compound_count() const { return compound_schema.size(); }
    std::size_t task_count() const { return action_count() + compound_count(); }
    std::size_t method_count() const { return method_task.size(); }
    auto cost_parts(ActionId action) const {
        return std::views::iota(cost_part_begin[action], cost_part_begin[action + 1]);
    }
    auto cost_alternatives(CostPartId part) const {
        return std::views::iota(cost_alternative_begin[part], cost_alternative_begin[part + 1]);
    }
    std::size_t cost_part_count() const { return cost_part_blocks.size(); }
    bool is_primitive(TaskId task) const { return task < action_count(); }
    std::span<const MethodId> methods_of(TaskId task) const { return compound_methods[task - action_count()]; }
};

}  // namespace relax

#endif
