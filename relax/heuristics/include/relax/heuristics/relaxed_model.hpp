#ifndef RELAX_HEURISTICS_RELAXED_MODEL_HPP
#define RELAX_HEURISTICS_RELAXED_MODEL_HPP

// Relaxed classical models of an HTN problem: operators that make facts true and never false.
//
// The *composition* model (buildRCModel of the paper's Algorithm 5). Facts: one that always holds; the state's facts;
// for facts that something reads negatively, their complements; and for every task the fact that it has been reached.
// An action makes its effects true and its task reached; it needs its preconditions. A method needs its distinct
// subtasks reached, makes its task reached, and is free. Only what is reachable from a node's network takes part.
//
// The *decomposition* model keeps more of the hierarchy: what is executed has been asked for, in time. For every task
// there is one more fact, that it may start, and for every method that costs something, that it has been entered. An
// action needs that its task may start. Entering a method needs that its task may start, and costs; it lets those
// subtasks start that nothing is ordered before; the others start when those before them have been reached. The method
// then makes its task reached when it has been entered and all subtasks have been reached.
//
// Effects with conditions become operators of their own. They share their action's cost: the action is the *owner*.
//
// Parts of an action's cost that are due on a condition are settled one after the other, between the action's
// preconditions and its effects: a part by an operator that needs the condition and costs its price, or by a free one
// that needs the condition's negation. Each part is an owner. What the action does needs the last part settled.
//
// This keeps the models admissible. Take a plan, and of each action in it the first execution: what holds in the state
// before has been reached by operators of earlier actions, so that all parts can be settled as they were in the plan,
// whose cost they do not exceed; whatever later executions do, needs them settled no more than once. The max heuristic
// pays for every execution on a way, in the state of which its parts are settled or due.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "relax/analysis/prices.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/rows.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

using RelaxedFact = std::uint32_t;
using OperatorId = std::uint32_t;
// Index space of costs: the actions, or the methods; then the cost parts, and one owner for all that is free.
using OwnerId = std::uint32_t;

class RelaxedModel {
public:
    // Both throw Stopped.
    static RelaxedModel composition(const GroundProblem& problem, const Prices& prices, Limits& limits);
    // `costs`: by MethodId, all at least 0. Actions are free but for their cost parts, whose prices are `parts`.
    static RelaxedModel decomposition(const GroundProblem& problem, std::span<const Cost> costs,
                                      std::span<const Cost> parts, Limits& limits);

    static constexpr RelaxedFact kAlwaysTrue = 0;

    std::size_t fact_count() const { return fact_count_; }
    std::size_t operator_count() const { return owner.size(); }
    // The size of what an evaluation may read.
    std::size_t bytes() const;
    RelaxedFact holds(FactId fact) const { return 1 + fact; }
    RelaxedFact reached(TaskId task) const { return reached_begin_ + task; }
    // Of the decomposition model alone.
    RelaxedFact may_start(TaskId task) const { return may_start_begin_ + task; }
    bool is_decomposition() const { return may_start_begin_ != 0; }
    // The fact that an action may start: the only readers are the action's operators.
    bool starts_action(RelaxedFact fact) const { return fact - may_start_begin_ < action_starts_; }

    // By OperatorId.
    Rows<RelaxedFact> preconditions;  // never empty
    Rows<RelaxedFact> adds;
    std::vector<OwnerId> owner;
    // By RelaxedFact.
    Rows<OperatorId> precondition_of;
    Rows<OperatorId> achievers;
    // By OwnerId.
    std::vector<Cost> owner_cost;
    Rows<OperatorId> owner_operators;
    // Facts that are read negatively, and the complement of each.
    std::vector<std::pair<FactId, RelaxedFact>> complements;

    // Of the composition model alone. By TaskId: an action's operators, or a compound task's methods. By operator of a
    // method: its distinct subtasks.
    Rows<OperatorId> task_operators;
    Rows<TaskId> operator_subtasks;
    std::vector<OperatorId> method_operator;  // by MethodId
    std::vector<TaskId> operator_task;        // by OperatorId: the action, or the task of the method
    // An operator that only settles a part of an action's cost is no step of its own.
    bool is_step(OperatorId op) const { return adds[op].front() < first_settled_; }

private:
    RelaxedModel(const GroundProblem& problem, std::span<const Cost> costs, std::span<const Cost> parts,
                 Limits& limits);

    void add_operator(std::vector<RelaxedFact> needed, std::vector<RelaxedFact> made, OwnerId owner_of_it);
    void add_action(const GroundProblem& problem, ActionId action, OwnerId owner_of_it);
    static std::vector<FactId> facts_of_priced_parts(const GroundProblem& problem, std::span<const Cost> parts,
                                                     Limits& limits);
    void settle_costs(const GroundProblem& problem, ActionId action, std::vector<RelaxedFact>& needed);
    void add_failures(const GroundProblem& problem, AlternativeId alternative, const std::vector<RelaxedFact>& needed,
                      RelaxedFact made);
    void add_composition(const GroundProblem& problem, MethodId method);
    void add_decomposition(const GroundProblem& problem, MethodId method);
    void index(Limits& limits);

    OwnerId part_owner(CostPartId part) const { return static_cast<OwnerId>(first_part_ + part); }
    RelaxedFact add_fact() { return static_cast<RelaxedFact>(fact_count_++); }
    OwnerId free_owner() const { return static_cast<OwnerId>(owner_cost.size() - 1); }

    std::size_t fact_count_ = 0;
    RelaxedFact reached_begin_ = 0;
    RelaxedFact may_start_begin_ = 0;
    RelaxedFact action_starts_ = 0;           // how many
    RelaxedFact first_settled_ = 0;           // of the facts about cost parts, which come last (composition model)
    std::size_t first_part_ = 0;              // its owner
    std::vector<RelaxedFact> complement_of_;  // by FactId; kAlwaysTrue where there is none
};

}  // namespace relax

#endif
