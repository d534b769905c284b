#include "relax/relaxed_plan.hpp"

#include <algorithm>
#include <functional>

#include "relax/tdg_bound.hpp"

namespace relax {

RelaxedPlan::RelaxedPlan(const RelaxedModel& model)
    : model_(model),
      facts_(model.fact_count(), {0, kGiven, 0}),
      operators_(model.operator_count(), {0, 0, 0}),
      in_plan_(model.operator_count(), 0),
      wanted_(model.fact_count(), 0) {
    Cost sum = 0;
    Cost count = 0;
    for (const Cost cost : model.owner_cost) {
        sum = add_bounds(sum, cost);
        count += cost > 0 ? 1 : 0;
    }
    step_ = std::max(Cost{1}, count == 0 ? Cost{1} : sum / count);
}

std::optional<Cost> RelaxedPlan::add(const RelaxedTask& task) {
    ++epoch_;
    queue_.clear();
    for (const OperatorId op : task.operators()) {
        operators_[op] = {weight(op), static_cast<std::uint32_t>(model_.preconditions[op].size()), epoch_};
    }
    for (const RelaxedFact fact : task.facts()) {
        offer(fact, 0, kGiven);
    }
    while (!queue_.empty()) {
        std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
        const auto [cost, fact] = queue_.back();
        queue_.pop_back();
        if (facts_[fact].cost != cost) {
            continue;
        }
        for (const OperatorId op : model_.precondition_of[fact]) {
            OperatorState& state = operators_[op];
            if (state.epoch != epoch_) {
                continue;
            }
            state.cost = add_bounds(state.cost, cost);
            if (--state.missing == 0) {
                for (const RelaxedFact made : model_.adds[op]) {
                    offer(made, state.cost, op);
                }
            }
        }
    }
    Cost sum = 0;
    for (const RelaxedFact goal : task.goals()) {
        if (facts_[goal].epoch != epoch_) {
            return std::nullopt;
        }
        sum = add_bounds(sum, facts_[goal].cost);
    }
    return sum;
}

std::optional<Cost> RelaxedPlan::ff(const RelaxedTask& task) {
    if (!add(task)) {
        return std::nullopt;
    }
    Cost total = 0;
    pending_.clear();
    const auto want = [this](RelaxedFact fact) {
        if (wanted_[fact] != epoch_) {
            wanted_[fact] = epoch_;
            pending_.push_back(fact);
        }
    };
    std::for_each(task.goals().begin(), task.goals().end(), want);
    while (!pending_.empty()) {
        const OperatorId op = facts_[pending_.back()].achiever;
        pending_.pop_back();
        if (op != kGiven && in_plan_[op] != epoch_) {
            in_plan_[op] = epoch_;
            total = add_bounds(total, weight(op));
            const auto needed = model_.preconditions[op];
            std::for_each(needed.begin(), needed.end(), want);
        }
    }
    return total;
}

void RelaxedPlan::offer(RelaxedFact fact, Cost cost, OperatorId achiever) {
    FactState& state = facts_[fact];
    if (state.epoch != epoch_ || cost < state.cost) {
        state = {cost, achiever, epoch_};
        queue_.emplace_back(cost, fact);
        std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
    }
}

}  // namespace relax
