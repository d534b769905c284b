#include "relax/heuristics/relaxed_model.hpp"

#include <algorithm>

namespace relax {

namespace {

// Turn "row -> values" round: for each value the rows that hold it.
template <typename Value>
Rows<std::uint32_t> invert(const Rows<Value>& rows, std::size_t value_count, Limits& limits) {
    std::vector<std::uint32_t> counts(value_count, 0);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        limits.stop_if_reached();
        for (const Value value : rows[row]) {
            ++counts[value];
        }
    }
    return Rows<std::uint32_t>::filled(counts, [&](const auto& put) {
        for (std::size_t row = 0; row < rows.size(); ++row) {
            limits.stop_if_reached();
            for (const Value value : rows[row]) {
                put(value, static_cast<std::uint32_t>(row));
            }
        }
    });
}

template <typename Value>
void sort_unique(std::vector<Value>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

RelaxedModel RelaxedModel::composition(const GroundProblem& problem, const Prices& prices, Limits& limits) {
    RelaxedModel model(problem, prices.actions, prices.parts, limits);
    model.first_settled_ = static_cast<RelaxedFact>(model.fact_count_);
    model.method_operator.resize(problem.method_count());
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        const auto first = static_cast<OperatorId>(model.operator_count());
        model.add_action(problem, action, action);
        for (OperatorId op = first; op < model.operator_count(); ++op) {
            model.task_operators.push(op);
            model.operator_task.push_back(action);
            model.operator_subtasks.finish_row();
        }
        model.task_operators.finish_row();
    }
    for (const TaskId task : problem.compounds()) {
        for (const MethodId method : problem.methods_of(task)) {
            limits.stop_if_reached();
            model.add_composition(problem, method);
        }
        model.task_operators.finish_row();
    }
    model.index(limits);
    return model;
}

RelaxedModel RelaxedModel::decomposition(const GroundProblem& problem, std::span<const Cost> costs,
                                         std::span<const Cost> parts, Limits& limits) {
    RelaxedModel model(problem, costs, parts, limits);
    model.may_start_begin_ = static_cast<RelaxedFact>(model.fact_count_);
    model.action_starts_ = static_cast<RelaxedFact>(problem.action_count());
    model.fact_count_ += problem.task_count();
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        model.add_action(problem, action, model.free_owner());
    }
    for (const MethodId method : problem.methods()) {
        limits.stop_if_reached();
        model.add_decomposition(problem, method);
    }
    model.index(limits);
    return model;
}

RelaxedModel::RelaxedModel(const GroundProblem& problem, std::span<const Cost> costs, std::span<const Cost> parts,
                           Limits& limits)
    : owner_cost(costs.begin(), costs.end()),
      first_part_(costs.size()),
      complement_of_(problem.fact_count(), kAlwaysTrue) {
    owner_cost.insert(owner_cost.end(), parts.begin(), parts.end());
    owner_cost.push_back(0);
    std::vector<FactId> negative = facts_of_priced_parts(problem, parts, limits);
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        const auto row = problem.negative_preconditions[action];
        negative.insert(negative.end(), row.begin(), row.end());
    }
    for (const EffectId effect : all_ids<EffectId>(problem.effect_negative_conditions.size())) {
        limits.stop_if_reached();
        const auto row = problem.effect_negative_conditions[effect];
        negative.insert(negative.end(), row.begin(), row.end());
    }
    sort_unique(negative);
    reached_begin_ = static_cast<RelaxedFact>(1 + problem.fact_count());
    for (const FactId fact : negative) {
        complement_of_[fact] = reached_begin_;
        complements.emplace_back(fact, reached_begin_++);
    }
    fact_count_ = reached_begin_ + problem.task_count();
}

void RelaxedModel::add_operator(std::vector<RelaxedFact> needed, std::vector<RelaxedFact> made, OwnerId owner_of_it) {
    if (needed.empty()) {
        needed.push_back(kAlwaysTrue);
    }
    sort_unique(needed);
    sort_unique(made);
    preconditions.add_row(needed);
    adds.add_row(made);
    owner.push_back(owner_of_it);
}

void RelaxedModel::add_action(const GroundProblem& problem, ActionId action, OwnerId owner_of_it) {
    std::vector<RelaxedFact> needed;
    if (is_decomposition()) {
        needed.push_back(may_start(action));
    }
    for (const FactId fact : problem.preconditions[action]) {
        needed.push_back(holds(fact));
    }
    for (const FactId fact : problem.negative_preconditions[action]) {
        needed.push_back(complement_of_[fact]);
    }
    settle_costs(problem, action, needed);
    std::vector<RelaxedFact> always{reached(action)};
    for (const EffectId effect : problem.effects[action]) {
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
            add_operator(std::move(condition), std::move(made), owner_of_it);
        }
    }
    add_operator(std::move(needed), std::move(always), owner_of_it);
}

void RelaxedModel::add_composition(const GroundProblem& problem, MethodId method) {
    const auto row = problem.method_subtasks[method];
    std::vector<TaskId> subtasks(row.begin(), row.end());
    sort_unique(subtasks);
    std::vector<RelaxedFact> needed;
    for (const TaskId subtask : subtasks) {
        needed.push_back(reached(subtask));
    }
    method_operator[method] = static_cast<OperatorId>(operator_count());
    task_operators.push(method_operator[method]);
    operator_task.push_back(problem.method_task[method]);
    operator_subtasks.add_row(subtasks);
    add_operator(std::move(needed), {reached(problem.method_task[method])}, free_owner());
}

void RelaxedModel::add_decomposition(const GroundProblem& problem, MethodId method) {
    const TaskId task = problem.method_task[method];
    const auto subtasks = problem.method_subtasks[method];
    const bool costs = owner_cost[method] > 0;
    const OwnerId pays = costs ? method : free_owner();
    if (subtasks.empty()) {
        add_operator({may_start(task)}, {reached(task)}, pays);
        return;
    }
    std::vector<std::vector<RelaxedFact>> earlier(subtasks.size());
    for (const auto& [first, then] : problem.method_ordering[method]) {
        earlier[then].push_back(reached(subtasks[first]));
    }
    // Where entering is free, the task may start, and that is all there is to it.
    const RelaxedFact entered = costs ? static_cast<RelaxedFact>(fact_count_++) : may_start(task);
    std::vector<RelaxedFact> first;
    std::vector<RelaxedFact> all;
    if (costs) {
        first.push_back(entered);
        all.push_back(entered);
    }
    for (std::size_t at = 0; at < subtasks.size(); ++at) {
        all.push_back(reached(subtasks[at]));
        if (earlier[at].empty()) {
            first.push_back(may_start(subtasks[at]));
        }
    }
    add_operator({may_start(task)}, std::move(first), pays);
    for (std::size_t at = 0; at < subtasks.size(); ++at) {
        if (!earlier[at].empty()) {
            earlier[at].push_back(entered);
            add_operator(std::move(earlier[at]), {may_start(subtasks[at])}, free_owner());
        }
    }
    add_operator(std::move(all), {reached(task)}, free_owner());
}

std::size_t RelaxedModel::bytes() const {
    return preconditions.bytes() + adds.bytes() + precondition_of.bytes() + achievers.bytes() +
           owner_operators.bytes() + owner.size() * sizeof(OwnerId) + owner_cost.size() * sizeof(Cost);
}

void RelaxedModel::index(Limits& limits) {
    precondition_of = invert(preconditions, fact_count(), limits);
    achievers = invert(adds, fact_count(), limits);
    std::vector<std::uint32_t> counts(owner_cost.size(), 0);
    for (const OwnerId pays : owner) {
        counts[pays] += pays == free_owner() ? 0 : 1;
    }
    owner_operators = Rows<OperatorId>::filled(counts, [&](const auto& put) {
        for (OperatorId op = 0; op < owner.size(); ++op) {
            limits.stop_if_reached();
            if (owner[op] != free_owner()) {
                put(owner[op], op);
            }
        }
    });
}

}  // namespace relax
