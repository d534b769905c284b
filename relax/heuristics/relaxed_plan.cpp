#include "relax/heuristics/relaxed_plan.hpp"

#include <algorithm>
#include <functional>

#include "relax/analysis/tdg_bound.hpp"

namespace relax {

RelaxedPlan::RelaxedPlan(const RelaxedModel& model, Limits& limits)
    : model_(model),
      limits_(limits),
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
    const Cost step = std::max(Cost{1}, count == 0 ? Cost{1} : sum / count);
    for (OperatorId op = 0; op < model.operator_count(); ++op) {
        limits.stop_if_reached();
        weight_.push_back(add_bounds(model.owner_cost[model.owner[op]], model.is_step(op) ? step : 0));
        preconditions_.push_back(static_cast<std::uint32_t>(model.preconditions[op].size()));
    }
    weigh_tasks();
}

// Knuth's algorithm, as for the decomposition-graph bound.
void RelaxedPlan::weigh_tasks() {
    least_weight_.assign(model_.task_operators.size(), kInfinity);
    std::vector<std::vector<OperatorId>> users(least_weight_.size());  // methods, once for each distinct subtask
    std::vector<std::size_t> missing(model_.operator_count(), 0);
    std::vector<Cost> sum = weight_;
    std::vector<std::pair<Cost, TaskId>> queue;
    const auto offer_weight = [&](TaskId task, Cost weight) {
        if (weight < least_weight_[task]) {
            least_weight_[task] = weight;
            queue.emplace_back(weight, task);
            std::push_heap(queue.begin(), queue.end(), std::greater<>());
        }
    };
    for (OperatorId op = 0; op < model_.operator_count(); ++op) {
        limits_.stop_if_reached();
        missing[op] = model_.operator_subtasks[op].size();
        for (const TaskId subtask : model_.operator_subtasks[op]) {
            users[subtask].push_back(op);
        }
        if (missing[op] == 0 && model_.is_step(op)) {
            offer_weight(model_.operator_task[op], weight_[op]);
        }
    }
    while (!queue.empty()) {
        limits_.stop_if_reached();
        std::pop_heap(queue.begin(), queue.end(), std::greater<>());
        const auto [weight, task] = queue.back();
        queue.pop_back();
        if (weight == least_weight_[task]) {
            for (const OperatorId op : users[task]) {
                sum[op] = add_bounds(sum[op], weight);
                if (--missing[op] == 0) {
                    offer_weight(model_.operator_task[op], sum[op]);
                }
            }
        }
    }
}

std::optional<Cost> RelaxedPlan::add(const RelaxedTask& task) {
    ++epoch_;
    queue_.clear();
    goals_.assign(task.goals().begin(), task.goals().end());
    std::sort(goals_.begin(), goals_.end());
    std::size_t open_goals =
        static_cast<std::size_t>(std::distance(goals_.begin(), std::unique(goals_.begin(), goals_.end())));
    goals_.resize(open_goals);
    for (const RelaxedFact goal : goals_) {
        wanted_[goal] = epoch_;
    }
    for (const RelaxedFact fact : task.facts()) {
        offer(fact, 0, kGiven);
    }
    // Facts leave the queue in order of their costs: with the last goal, all that matters is known.
    while (!queue_.empty() && open_goals > 0) {
        limits_.stop_if_reached();
        std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
        const auto [cost, fact] = queue_.back();
        queue_.pop_back();
        if (facts_[fact].cost != cost) {
            continue;
        }
        open_goals -= wanted_[fact] == epoch_ ? 1 : 0;
        work_ += model_.precondition_of[fact].size();
        for (const OperatorId op : model_.precondition_of[fact]) {
            OperatorState& state = operators_[op];
            if (state.epoch != epoch_) {
                if (!task.is_reachable(op)) {
                    continue;
                }
                state = {weight_[op], preconditions_[op], epoch_};
            }
            state.cost = add_bounds(state.cost, cost);
            if (--state.missing == 0) {
                for (const RelaxedFact made : model_.adds[op]) {
                    offer(made, state.cost, op);
                }
            }
        }
    }
    return open_goals > 0 ? std::nullopt : std::optional(goal_costs(task));
}

Cost RelaxedPlan::goal_costs(const RelaxedTask& task) const {
    Cost sum = 0;
    for (const RelaxedFact goal : task.goals()) {
        sum = add_bounds(sum, facts_[goal].cost);
    }
    return sum;
}

std::optional<Cost> RelaxedPlan::ff(const RelaxedTask& task) {
    if (!add(task)) {
        return std::nullopt;
    }
    Cost once = 0;  // the least weight of the network's distinct tasks
    for (const RelaxedFact goal : goals_) {
        once = add_bounds(once, least_weight_[goal - model_.reached(TaskId{0})]);
    }
    Cost all = 0;
    for (const RelaxedFact goal : task.goals()) {
        all = add_bounds(all, least_weight_[goal - model_.reached(TaskId{0})]);
    }
    return std::max(add_bounds(extract_plan(task), all - once), all);
}

// Collect the cheapest achievers of the goals, of their preconditions, and so on. Returns their weight.
Cost RelaxedPlan::extract_plan(const RelaxedTask& task) {
    Cost total = 0;
    pending_.assign(goals_.begin(), goals_.end());
    for (const RelaxedFact fact : task.facts()) {
        wanted_[fact] = epoch_;
    }
    while (!pending_.empty()) {
        limits_.stop_if_reached();
        const OperatorId op = facts_[pending_.back()].achiever;
        pending_.pop_back();
        if (op != kGiven && in_plan_[op] != epoch_) {
            in_plan_[op] = epoch_;
            ++work_;
            total = add_bounds(total, weight_[op]);
            for (const RelaxedFact needed : model_.preconditions[op]) {
                if (wanted_[needed] != epoch_) {
                    wanted_[needed] = epoch_;
                    pending_.push_back(needed);
                }
            }
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
