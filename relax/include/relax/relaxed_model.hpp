#ifndef RELAX_RELAXED_MODEL_HPP
#define RELAX_RELAXED_MODEL_HPP

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

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "relax/ground_problem.hpp"
#include "relax/ids.hpp"
#include "relax/limits.hpp"

namespace relax {

using RelaxedFact = std::uint32_t;
using OperatorId = std::uint32_t;
// Index space of costs: the actions, or the methods, and after them one owner for all that is free.
using OwnerId = std::uint32_t;

class RelaxedModel {
public:
    // Both throw Stopped.
    // `costs`: by ActionId, all at least 0.
    static RelaxedModel composition(const GroundProblem& problem, std::span<const Cost> costs, Limits& limits);
    // `costs`: by MethodId, all at least 0; actions are free.
    static RelaxedModel decomposition(const GroundProblem& problem, std::span<const Cost> costs, Limits& limits);

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

private:
    RelaxedModel(const GroundProblem& problem, std::span<const Cost> costs, Limits& limits);

    void add_operator(std::vector<RelaxedFact> needed, std::vector<RelaxedFact> made, OwnerId owner_of_it);
    void add_action(const GroundProblem& problem, ActionId action, OwnerId owner_of_it);
    void add_composition(const GroundProblem& problem, MethodId method);
    void add_decomposition(const GroundProblem& problem, MethodId method);
    void index(Limits& limits);

    OwnerId free_owner() const { return static_cast<OwnerId>(owner_cost.size() - 1); }

    std::size_t fact_count_ = 0;
    RelaxedFact reached_begin_ = 0;
    RelaxedFact may_start_begin_ = 0;
    RelaxedFact action_starts_ = 0;           // how many
    std::vector<RelaxedFact> complement_of_;  // by FactId; kAlwaysTrue where there is none
};

}  // namespace relax

#endif
