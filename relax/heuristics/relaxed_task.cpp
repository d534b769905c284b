#include "relax/heuristics/relaxed_task.hpp"

#include "relax/networks/ordered_tasks.hpp"
#include "relax/problem/state.hpp"

namespace relax {

RelaxedTask::RelaxedTask(const RelaxedModel& model, bool lists_operators, Limits& limits)
    : model_(model),
      limits_(limits),
      lists_operators_(lists_operators),
      free_owner_(static_cast<OwnerId>(model.owner_cost.size() - 1)),
      seen_(model.task_operators.size(), 0),
      fact_count_(model.fact_count()) {
    if (model.is_decomposition()) {
        first_reader_.assign(model.fact_count(), {0, kEnd});
        first_achiever_.assign(model.fact_count(), {0, kEnd});
    }
}

void RelaxedTask::set(const NodeView& node) {
    ++epoch_;
    set_facts(node.state);
    goals_.clear();
    for (const TaskId task : node.tasks) {
        goals_.push_back(model_.reached(task));
    }
    if (model_.is_decomposition()) {
        start_in_order(node);
    } else {
        for (const TaskId task : node.tasks) {
            reach(task);
        }
        reach_operators();
    }
}

void RelaxedTask::set_facts(std::span<const std::uint64_t> state) {
    facts_.assign(1, RelaxedModel::kAlwaysTrue);
    for_each_bit(state, [this](std::size_t fact) { facts_.push_back(model_.holds(static_cast<FactId>(fact))); });
    for (const auto& [fact, complement] : model_.complements) {
        if (!holds(state, fact)) {
            facts_.push_back(complement);
        }
    }
}

void RelaxedTask::reach_operators() {
    operators_.clear();
    while (!pending_.empty()) {
        limits_.stop_if_reached();
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

void RelaxedTask::start_in_order(const NodeView& node) {
    starts_.clear();
    order_needs_.clear();
    order_makes_.clear();
    readers_.clear();
    achievers_.clear();
    fact_count_ = model_.fact_count();
    if (node.is_totally_ordered) {
        start_one_by_one(node.tasks);
        return;
    }
    const std::size_t words = words_for(node.tasks.size());
    for (std::size_t at = 0; at < node.tasks.size(); ++at) {
        limits_.stop_if_reached();
        needed_.clear();
        if (!node.predecessors.empty()) {
            for_each_bit(node.predecessors.subspan(at * words, words),
                         [&](std::size_t earlier) { needed_.push_back(model_.reached(node.tasks[earlier])); });
        }
        if (needed_.empty()) {
            starts_.push_back(model_.may_start(node.tasks[at]));
        } else {
            add_order(needed_, {{model_.may_start(node.tasks[at])}});
        }
    }
}

// A fact for each place in the list, that all up to there is done; so each operator needs but two facts.
void RelaxedTask::start_one_by_one(std::span<const TaskId> tasks) {
    goals_.clear();
    if (tasks.empty()) {
        return;
    }
    starts_.push_back(model_.may_start(tasks.front()));
    needed_.assign(1, model_.reached(tasks.front()));
    for (const TaskId task : tasks.subspan(1)) {
        limits_.stop_if_reached();
        const RelaxedFact done = add_fact();
        add_order(needed_, {{done, model_.may_start(task)}});
        needed_.assign({done, model_.reached(task)});
    }
    goals_.push_back(add_fact());
    add_order(needed_, goals_);
}

RelaxedFact RelaxedTask::add_fact() {
    const auto fact = static_cast<RelaxedFact>(fact_count_++);
    if (fact >= first_reader_.size()) {
        first_reader_.push_back({0, kEnd});
        first_achiever_.push_back({0, kEnd});
    }
    return fact;
}

void RelaxedTask::add_order(std::span<const RelaxedFact> needed, std::span<const RelaxedFact> made) {
    const auto op = static_cast<OperatorId>(operator_count());
    for (const RelaxedFact fact : needed) {
        chain(first_reader_, readers_, fact, op);
    }
    for (const RelaxedFact fact : made) {
        chain(first_achiever_, achievers_, fact, op);
    }
    order_needs_.add_row(needed);
    order_makes_.add_row(made);
}

void RelaxedTask::chain(std::vector<Start>& starts, std::vector<Link>& links, RelaxedFact fact, OperatorId op) const {
    Start& start = starts[fact];
    links.push_back({op, start.epoch == epoch_ ? start.link : kEnd});
    start = {epoch_, static_cast<std::uint32_t>(links.size() - 1)};
}

}  // namespace relax
