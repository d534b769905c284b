#include "relax/heuristics/hmax.hpp"

#include <algorithm>
#include <functional>

#include "relax/base/cost.hpp"

namespace relax {

HMax::HMax(const RelaxedModel& model, Limits& limits)
    : model_(model), limits_(limits), facts_(model.fact_count(), {kInfinity, 0, false}) {
    for (OperatorId op = 0; op < model.operator_count(); ++op) {
        limits.stop_if_reached();
        const auto row = model.preconditions[op];
        const bool wakes_up = !model.is_decomposition() ||
                              std::ranges::any_of(row, [&](RelaxedFact fact) { return model.starts_action(fact); });
        operators_.push_back({0, 0, 0, 0, wakes_up ? 0 : static_cast<std::uint32_t>(row.size())});
    }
}

std::optional<Cost> HMax::run(const RelaxedTask& task, std::span<const Cost> costs) {
    ++epoch_;
    queue_.clear();
    level_facts_.clear();
    level_ = 0;
    make_room(task);
    for (const RelaxedFact fact : task.facts()) {
        facts_[fact] = {0, epoch_, true};
    }
    for (const RelaxedFact fact : task.starts()) {
        offer(fact, 0);
    }
    looks_ += task.operators().size();
    for (const OperatorId op : task.operators()) {
        limits_.stop_if_reached();
        wake(task, op, model_.preconditions[op].front(), 0, costs);
    }
    while (!is_empty()) {
        limits_.stop_if_reached();
        const auto [cost_of_it, fact] = pop();
        if (facts_[fact].cost != cost_of_it || facts_[fact].is_settled) {
            continue;
        }
        facts_[fact].is_settled = true;
        const bool wakes = model_.is_decomposition() && model_.starts_action(fact);
        task.for_each_reader(fact, [&](OperatorId op) {
            ++looks_;
            OperatorState& state = operators_[op];
            if (wakes) {
                wake(task, op, fact, cost_of_it, costs);
                return;
            }
            if (state.epoch != epoch_) {
                if (state.count == 0) {
                    return;  // it wakes up later, or never
                }
                state.epoch = epoch_;
                state.missing = state.count;
            }
            // Facts leave the queue in order of cost, so the last precondition to be reached is the most expensive.
            if (--state.missing == 0) {
                reach(task, op, fact, cost_of_it, costs);
            }
        });
    }
    const Cost most_expensive = find_most_expensive_goal(task.goals());
    return most_expensive == kInfinity ? std::nullopt : std::optional(most_expensive);
}

Cost HMax::lower(const RelaxedTask& task, std::span<const OperatorId> operators, std::span<const Cost> costs) {
    level_ = 0;
    const auto offer_adds = [&](OperatorId op) {
        const Cost cost_of_it = add_bounds(operators_[op].supporter_cost, costs[task.owner(op)]);
        for (const RelaxedFact made : task.adds(op)) {
            offer(made, cost_of_it);
        }
    };
    for (const OperatorId op : operators) {
        if (is_reached(op)) {
            offer_adds(op);
        }
    }
    while (!is_empty()) {
        limits_.stop_if_reached();
        const auto [cost_of_it, fact] = pop();
        if (facts_[fact].cost != cost_of_it) {
            continue;
        }
        task.for_each_reader(fact, [&, fact = fact](OperatorId op) {
            ++looks_;
            OperatorState& state = operators_[op];
            if (!is_reached(op) || state.supporter != fact) {
                return;
            }
            const Cost before = state.supporter_cost;
            support_by_most_expensive(task.preconditions(op), state);
            if (state.supporter_cost < before) {
                offer_adds(op);
            }
        });
    }
    return find_most_expensive_goal(task.goals());
}

// For the facts and operators of the network.
void HMax::make_room(const RelaxedTask& task) {
    if (task.fact_count() > facts_.size()) {
        facts_.resize(task.fact_count(), {kInfinity, 0, false});
    }
    const std::size_t known = model_.operator_count();
    if (task.operator_count() > operators_.size()) {
        operators_.resize(task.operator_count());
    }
    for (std::size_t op = known; op < task.operator_count(); ++op) {
        const auto count = static_cast<std::uint32_t>(task.preconditions(static_cast<OperatorId>(op)).size());
        operators_[op] = {0, 0, count, epoch_, count};
    }
}

// Count the preconditions that are not yet reached. If none is missing, `fact`, the latest to be reached, is the most
// expensive one.
void HMax::wake(const RelaxedTask& task, OperatorId op, RelaxedFact fact, Cost cost_of_it,
                std::span<const Cost> costs) {
    OperatorState& state = operators_[op];
    state.epoch = epoch_;
    state.missing = 0;
    for (const RelaxedFact needed : model_.preconditions[op]) {
        const FactState& reached = facts_[needed];
        state.missing += reached.epoch == epoch_ && reached.is_settled ? 0 : 1;
    }
    if (state.missing == 0) {
        reach(task, op, fact, cost_of_it, costs);
    }
}

void HMax::reach(const RelaxedTask& task, OperatorId op, RelaxedFact fact, Cost cost_of_it,
                 std::span<const Cost> costs) {
    OperatorState& state = operators_[op];
    state.supporter = fact;
    state.supporter_cost = cost_of_it;
    const Cost made_for = add_bounds(cost_of_it, costs[task.owner(op)]);
    for (const RelaxedFact made : task.adds(op)) {
        offer(made, made_for);
    }
}

void HMax::offer(RelaxedFact fact, Cost cost_of_it) {
    if (cost_of_it >= cost(fact)) {
        return;
    }
    facts_[fact] = {cost_of_it, epoch_, false};
    if (cost_of_it == level_) {
        level_facts_.push_back(fact);
    } else {
        queue_.emplace_back(cost_of_it, fact);
        std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
    }
}

HMax::QueueEntry HMax::pop() {
    if (!level_facts_.empty()) {
        const RelaxedFact fact = level_facts_.back();
        level_facts_.pop_back();
        return {level_, fact};
    }
    std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
    const QueueEntry entry = queue_.back();
    queue_.pop_back();
    level_ = entry.first;
    return entry;
}

void HMax::support_by_most_expensive(std::span<const RelaxedFact> preconditions, OperatorState& state) const {
    RelaxedFact most_expensive = preconditions.front();
    for (const RelaxedFact fact : preconditions.subspan(1)) {
        if (facts_[fact].cost > facts_[most_expensive].cost) {
            most_expensive = fact;
        }
    }
    state.supporter = most_expensive;
    state.supporter_cost = facts_[most_expensive].cost;
}

Cost HMax::find_most_expensive_goal(std::span<const RelaxedFact> goals) {
    Cost most_expensive = 0;
    most_expensive_goal_ = RelaxedModel::kAlwaysTrue;
    for (const RelaxedFact goal : goals) {
        if (cost(goal) > most_expensive) {
            most_expensive = cost(goal);
            most_expensive_goal_ = goal;
        }
    }
    return most_expensive;
}

}  // namespace relax
