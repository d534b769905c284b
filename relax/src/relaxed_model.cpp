#include "relax/relaxed_model.hpp"

#include <algorithm>
#include <bit>

#include "relax/state.hpp"

namespace relax {

namespace {

// Turn "row -> values" round: for each value the rows that hold it.
template <typename Value>
Rows<std::uint32_t> invert(const Rows<Value>& rows, std::size_t value_count) {
    std::vector<std::vector<std::uint32_t>> lists(value_count);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        for (const Value value : rows[row]) {
            lists[value].push_back(static_cast<std::uint32_t>(row));
        }
    }
    Rows<std::uint32_t> result;
    for (const auto& list : lists) {
        result.add_row(list);
    }
    return result;
}

template <typename Value>
void sort_unique(std::vector<Value>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

RelaxedModel::RelaxedModel(const GroundProblem& problem, std::span<const Cost> costs,
                           std::span<const Cost> method_costs)
    : complement_of_(problem.fact_count(), kAlwaysTrue) {
    std::vector<FactId> negative;
    for (ActionId action = 0; action < problem.action_count(); ++action) {
        const auto row = problem.negative_preconditions[action];
        negative.insert(negative.end(), row.begin(), row.end());
    }
    for (EffectId effect = 0; effect < problem.effect_negative_conditions.size(); ++effect) {
        const auto row = problem.effect_negative_conditions[effect];
        negative.insert(negative.end(), row.begin(), row.end());
    }
    sort_unique(negative);
    auto next = static_cast<RelaxedFact>(1 + problem.fact_count());
    for (const FactId fact : negative) {
        complement_of_[fact] = next;
        complements.emplace_back(fact, next++);
    }
    reached_begin_ = next;

    owner_cost.assign(costs.begin(), costs.end());
    owner_cost.insert(owner_cost.end(), method_costs.begin(), method_costs.end());
    const bool methods_are_free = method_costs.empty();
    if (methods_are_free) {
        owner_cost.push_back(0);
    }
    method_operator.resize(problem.method_count());
    const auto first_method = static_cast<OwnerId>(problem.action_count());
    for (ActionId action = 0; action < problem.action_count(); ++action) {
        add_action(problem, action);
    }
    for (TaskId task = static_cast<TaskId>(problem.action_count()); task < problem.task_count(); ++task) {
        for (const MethodId method : problem.methods_of(task)) {
            method_operator[method] = static_cast<OperatorId>(owner.size());
            task_operators.push(method_operator[method]);
            add_method(problem, method, methods_are_free ? first_method : first_method + method);
        }
        task_operators.finish_row();
    }
    index();
}

void RelaxedModel::add_action(const GroundProblem& problem, ActionId action) {
    std::vector<RelaxedFact> needed;
    for (const FactId fact : problem.preconditions[action]) {
        needed.push_back(holds(fact));
    }
    for (const FactId fact : problem.negative_preconditions[action]) {
        needed.push_back(complement_of_[fact]);
    }
    std::vector<RelaxedFact> always{reached(action)};
    const auto add_operator = [&](std::vector<RelaxedFact> preconditions_of_it, std::vector<RelaxedFact> adds_of_it) {
        if (preconditions_of_it.empty()) {
            preconditions_of_it.push_back(kAlwaysTrue);
        }
        sort_unique(preconditions_of_it);
        sort_unique(adds_of_it);
        preconditions.add_row(preconditions_of_it);
        adds.add_row(adds_of_it);
        task_operators.push(static_cast<OperatorId>(owner.size()));
        owner.push_back(action);
        operator_task.push_back(action);
        operator_subtasks.finish_row();
    };
    for (EffectId effect = problem.effect_begin[action]; effect < problem.effect_begin[action + 1]; ++effect) {
        std::vector<RelaxedFact> made;
        for (const FactId fact : problem.effect_adds[effect]) {
            made.push_back(holds(fact));
        }
        for (const FactId fact : problem.effect_deletes[effect]) {
            if (complement_of_[fact] != kAlwaysTrue) {
                made.push_back(complement_of_[fact]);
            }
        }
        std::vector<RelaxedFact> condition;
        for (const FactId fact : problem.effect_conditions[effect]) {
            condition.push_back(holds(fact));
        }
        for (const FactId fact : problem.effect_negative_conditions[effect]) {
            condition.push_back(complement_of_[fact]);
        }
        if (condition.empty()) {
            always.insert(always.end(), made.begin(), made.end());
        } else if (!made.empty()) {
            condition.insert(condition.end(), needed.begin(), needed.end());
            add_operator(std::move(condition), std::move(made));
        }
    }
    add_operator(std::move(needed), std::move(always));
    task_operators.finish_row();
}

void RelaxedModel::add_method(const GroundProblem& problem, MethodId method, OwnerId owner_of_it) {
    const auto row = problem.method_subtasks[method];
    std::vector<TaskId> subtasks(row.begin(), row.end());
    sort_unique(subtasks);
    operator_subtasks.add_row(subtasks);
    for (const TaskId subtask : subtasks) {
        preconditions.push(reached(subtask));
    }
    if (subtasks.empty()) {
        preconditions.push(kAlwaysTrue);
    }
    preconditions.finish_row();
    adds.push(reached(problem.method_task[method]));
    adds.finish_row();
    owner.push_back(owner_of_it);
    operator_task.push_back(problem.method_task[method]);
}

void RelaxedModel::index() {
    precondition_of = invert(preconditions, fact_count());
    achievers = invert(adds, fact_count());
    std::vector<std::vector<OperatorId>> owned(owner_cost.size());
    for (OperatorId op = 0; op < owner.size(); ++op) {
        owned[owner[op]].push_back(op);
    }
    for (const auto& list : owned) {
        owner_operators.add_row(list);
    }
}

void RelaxedTask::set(std::span<const std::uint64_t> state, std::span<const TaskId> tasks) {
    ++epoch_;
    facts_.assign(1, RelaxedModel::kAlwaysTrue);
    for (std::size_t word = 0; word < state.size(); ++word) {
        for (std::uint64_t bits = state[word]; bits != 0; bits &= bits - 1) {
            const auto fact = static_cast<FactId>(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
            facts_.push_back(model_.holds(fact));
        }
    }
    for (const auto& [fact, complement] : model_.complements) {
        if (!holds(state, fact)) {
            facts_.push_back(complement);
        }
    }
    goals_.clear();
    operators_.clear();
    for (const TaskId task : tasks) {
        goals_.push_back(model_.reached(task));
        reach(task);
    }
    while (!pending_.empty()) {
        const TaskId task = pending_.back();
        pending_.pop_back();
        for (const OperatorId op : model_.task_operators[task]) {
            if (lists_operators_) {
                operators_.push_back(op);
            }
            for (const TaskId subtask : model_.operator_subtasks[op]) {
                reach(subtask);
            }
        }
    }
}

void RelaxedTask::reach(TaskId task) {
    if (seen_[task] != epoch_) {
        seen_[task] = epoch_;
        pending_.push_back(task);
    }
}

}  // namespace relax
