#include "relax/hmax.hpp"

#include <algorithm>
#include <functional>

namespace relax {

HMax::HMax(const RelaxedModel& model)
    : model_(model), facts_(model.fact_count(), {kInfinite, 0}), operators_(model.operator_count(), {0, 0, 0, 0}) {}

std::optional<Cost> HMax::run(const RelaxedTask& task, std::span<const Cost> costs) {
    ++epoch_;
    queue_.clear();
    looks_ += task.operators().size();
    for (const OperatorId op : task.operators()) {
        operators_[op] = {0, 0, static_cast<std::uint32_t>(model_.preconditions[op].size()), epoch_};
    }
    for (const RelaxedFact fact : task.facts()) {
        offer(fact, 0);
    }
    while (!queue_.empty()) {
        const auto [cost_of_it, fact] = pop();
        if (facts_[fact].cost != cost_of_it) {
            continue;
        }
        const auto readers = model_.precondition_of[fact];
        looks_ += readers.size();
        for (const OperatorId op : readers) {
            OperatorState& state = operators_[op];
            // Facts leave the queue in order of cost, so the last precondition to be reached is the dearest.
            if (state.epoch == epoch_ && --state.missing == 0) {
                state.supporter = fact;
                state.supporter_cost = cost_of_it;
                for (const RelaxedFact made : model_.adds[op]) {
                    offer(made, cost_of_it + costs[model_.owner[op]]);
                }
            }
        }
    }
    goals_.assign(task.goals().begin(), task.goals().end());
    const Cost dearest = find_dearest_goal();
    return dearest == kInfinite ? std::nullopt : std::optional(dearest);
}

Cost HMax::lower(std::span<const OperatorId> operators, std::span<const Cost> costs) {
    for (const OperatorId op : operators) {
        if (is_reached(op)) {
            for (const RelaxedFact made : model_.adds[op]) {
                offer(made, operators_[op].supporter_cost + costs[model_.owner[op]]);
            }
        }
    }
    while (!queue_.empty()) {
        const auto [cost_of_it, fact] = pop();
        if (facts_[fact].cost != cost_of_it) {
            continue;
        }
        const auto readers = model_.precondition_of[fact];
        looks_ += readers.size();
        for (const OperatorId op : readers) {
            if (!is_reached(op) || operators_[op].supporter != fact) {
                continue;
            }
            const Cost before = operators_[op].supporter_cost;
            support_by_dearest(op);
            if (operators_[op].supporter_cost < before) {
                for (const RelaxedFact made : model_.adds[op]) {
                    offer(made, operators_[op].supporter_cost + costs[model_.owner[op]]);
                }
            }
        }
    }
    return find_dearest_goal();
}

void HMax::offer(RelaxedFact fact, Cost cost_of_it) {
    if (cost_of_it < cost(fact)) {
        facts_[fact] = {cost_of_it, epoch_};
        queue_.emplace_back(cost_of_it, fact);
        std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
    }
}

HMax::QueueEntry HMax::pop() {
    std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
    const QueueEntry entry = queue_.back();
    queue_.pop_back();
    return entry;
}

void HMax::support_by_dearest(OperatorId op) {
    const auto row = model_.preconditions[op];
    RelaxedFact dearest = row.front();
    for (const RelaxedFact fact : row.subspan(1)) {
        if (facts_[fact].cost > facts_[dearest].cost) {
            dearest = fact;
        }
    }
    operators_[op].supporter = dearest;
    operators_[op].supporter_cost = facts_[dearest].cost;
}

Cost HMax::find_dearest_goal() {
    Cost dearest = 0;
    dearest_goal_ = RelaxedModel::kAlwaysTrue;
    for (const RelaxedFact goal : goals_) {
        if (cost(goal) > dearest) {
            dearest = cost(goal);
            dearest_goal_ = goal;
        }
    }
    return dearest;
}

}  // namespace relax
