#ifndef RELAX_RELAXED_MODEL_HPP
#define RELAX_RELAXED_MODEL_HPP

// The relaxed classical model of an HTN problem (buildRCModel of the paper's Algorithm 5).
//
// Facts: one that always holds; the state's facts; for facts that something reads negatively, their complements; and
// for every task the fact that it has been reached. An action makes its effects true and its task reached; it needs its
// preconditions. A method needs its distinct subtasks reached, makes its task reached, and is free. Deletes are
// ignored. A node's goals are the reached facts of its network's tasks; only what is reachable from that network takes
// part.
//
// Effects with conditions become operators of their own. They share their action's cost: the action is the *owner*.

#include <cstdint>
#include <span>
#include <vector>

#include "relax/ground_problem.hpp"
#include "relax/ids.hpp"

namespace relax {

using RelaxedFact = std::uint32_t;
using OperatorId = std::uint32_t;
// Index space of costs: the actions, then either the methods, or one owner for all methods, which costs nothing.
using OwnerId = std::uint32_t;

class RelaxedModel {
public:
    // `costs`: by ActionId, `method_costs`: by MethodId, or empty where methods are free. All at least 0.
    RelaxedModel(const GroundProblem& problem, std::span<const Cost> costs, std::span<const Cost> method_costs = {});

    static constexpr RelaxedFact kAlwaysTrue = 0;

    std::size_t fact_count() const { return reached_begin_ + task_operators.size(); }
    std::size_t operator_count() const { return owner.size(); }
    RelaxedFact holds(FactId fact) const { return 1 + fact; }
    RelaxedFact reached(TaskId task) const { return reached_begin_ + task; }

    // By OperatorId.
    Rows<RelaxedFact> preconditions;  // never empty
    Rows<RelaxedFact> adds;
    std::vector<OwnerId> owner;
    // By RelaxedFact.
    Rows<OperatorId> precondition_of;
    Rows<OperatorId> achievers;
    // By TaskId: an action's operators, or a compound task's methods. By operator of a method: its distinct subtasks.
    Rows<OperatorId> task_operators;
    Rows<TaskId> operator_subtasks;
    std::vector<OperatorId> method_operator;  // by MethodId
    std::vector<TaskId> operator_task;        // by OperatorId: the action, or the task of the method
    // By OwnerId.
    std::vector<Cost> owner_cost;
    Rows<OperatorId> owner_operators;

    // Facts that are read negatively, and the complement of each.
    std::vector<std::pair<FactId, RelaxedFact>> complements;

private:
    void add_action(const GroundProblem& problem, ActionId action);
    void add_method(const GroundProblem& problem, MethodId method, OwnerId owner_of_it);
    void index();

    RelaxedFact reached_begin_ = 0;
    std::vector<RelaxedFact> complement_of_;  // by FactId; kAlwaysTrue where there is none
};

// What of the relaxed model a search node sees: its facts, its goals, and the operators reachable from its network.
class RelaxedTask {
public:
    // `lists_operators`: whether `operators` is asked for, which takes a while on large problems.
    RelaxedTask(const RelaxedModel& model, bool lists_operators)
        : model_(model), lists_operators_(lists_operators), seen_(model.task_operators.size(), 0) {}

    // `state`: bits by FactId in words of 64; `tasks`: of the network, repetitions allowed.
    void set(std::span<const std::uint64_t> state, std::span<const TaskId> tasks);

    const RelaxedModel& model() const { return model_; }
    std::span<const RelaxedFact> facts() const { return facts_; }
    std::span<const RelaxedFact> goals() const { return goals_; }
    std::span<const OperatorId> operators() const { return operators_; }
    bool is_reachable(OperatorId op) const { return seen_[model_.operator_task[op]] == epoch_; }

private:
    void reach(TaskId task);

    const RelaxedModel& model_;
    bool lists_operators_;
    std::vector<RelaxedFact> facts_;
    std::vector<RelaxedFact> goals_;
    std::vector<OperatorId> operators_;
    std::vector<TaskId> pending_;
    std::vector<std::uint32_t> seen_;  // by TaskId: the epoch in which it was seen
    std::uint32_t epoch_ = 0;
};

}  // namespace relax

#endif
