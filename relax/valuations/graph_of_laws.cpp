#include "relax/valuations/graph_of_laws.hpp"

#include <algorithm>
#include <cassert>
#include <queue>
#include <utility>

#include "relax/base/cost.hpp"
#include "relax/valuations/law_bounds.hpp"
#include "relax/valuations/law_orders.hpp"

namespace relax {

namespace {

constexpr std::uint8_t kMostRoundsOfTask = 250;
constexpr double kRoundLift = 0x1p-32;

}  // namespace

GraphOfLaws::GraphOfLaws(const GroundProblem& problem, LawTable& table, std::span<const LawId> action_laws,
                         std::span<const Cost> least, std::span<const Cost> means, Limits& limits)
    : problem_(problem),
      table_(table),
      laws_(problem.task_count()),
      is_known_(problem.task_count(), false),
      rounds_(problem.task_count(), 0) {
    for (const ActionId action : problem.actions()) {
        laws_[task_of(action)] = action_laws[action];
        is_known_[task_of(action)] = true;
    }
    const auto methods_with = invert(problem.method_subtasks, problem.task_count(), limits);
    // Those with low means first: what one of them adds to the others, it adds before these are looked at, mostly.
    const auto later = [&](TaskId one, TaskId other) {
        return means[one] != means[other] ? means[one] > means[other] : one > other;
    };
    std::priority_queue<TaskId, std::vector<TaskId>, decltype(later)> queue(later);
    std::vector<bool> is_queued(problem.task_count(), false);
    for (const TaskId task : problem.compounds()) {
        if (means[task] < kInfinity) {
            queue.push(task);
            is_queued[task] = true;
        }
    }
    while (!queue.empty()) {
        limits.stop_if_reached();
        const TaskId task = queue.top();
        queue.pop();
        is_queued[task] = false;
        if (rounds_[task] > kMostRoundsOfTask) {
            continue;
        }
        if (++rounds_[task] > kMostRoundsOfTask) {
            at_.assign(1, static_cast<double>(least[task]));
            probability_.assign(1, 1.0);
            laws_[task] = table_.add(at_, probability_);
        } else if (!update(task, limits)) {
            continue;
        }
        for (const MethodId method : methods_with[task]) {
            const TaskId parent = problem.method_task[method];
            if (!is_queued[parent] && means[parent] < kInfinity) {
                is_queued[parent] = true;
                queue.push(parent);
            }
        }
    }
    for (const TaskId task : problem.compounds()) {
        if (is_known_[task]) {
            laws_[task] = lifted(table_, laws_[task], kRoundLift);
        }
    }
}

// Whether the task has changed.
bool GraphOfLaws::update(TaskId task, Limits& limits) {
    bool is_known = is_known_[task];
    LawId law = laws_[task];
    for (const MethodId method : problem_.methods_of(task)) {
        const auto subtasks = problem_.method_subtasks[method];
        if (!std::ranges::all_of(subtasks, [this](TaskId subtask) { return is_known_[subtask]; })) {
            continue;
        }
        LawId sum = LawTable::kFree;
        for (const TaskId subtask : subtasks) {
            sum = table_.sum(sum, laws_[subtask], limits);
        }
        law = is_known ? highest_of(table_, law, sum) : sum;
        is_known = true;
    }
    if (!is_known || (is_known_[task] && is_never_more(table_[laws_[task]], table_[law]))) {
        return false;
    }
    is_known_[task] = true;
    laws_[task] = law;
    return true;
}

const Law& NetworkLaws::of(NetworkId network, Limits& limits) {
    while (network >= by_network_.size()) {
        by_network_.push_back(kUnknown);
    }
    LawId law = by_network_[network];
    if (law == kUnknown) {
        tasks_.clear();
        networks_.tasks(network, tasks_);
        laws_.clear();
        for (const TaskId task : tasks_) {
            laws_.push_back(of_task(task));
        }
        // Networks share their ends where they are lists, and a few components in any order where they are not.
        if (networks_.are_totally_ordered()) {
            std::ranges::reverse(laws_);
        } else {
            std::ranges::sort(laws_);
        }
        law = LawTable::kFree;
        for (const LawId summand : laws_) {
            law = table_.sum(law, summand, limits);
        }
        by_network_[network] = law;
    }
    return table_[law];
}

LawId NetworkLaws::of_task(TaskId task) {
    if (task >= by_task_.size()) {
        by_task_.resize(task + 1, kUnknown);
    }
    if (by_task_[task] == kUnknown) {
        const Law& law = task_table_[graph_[task]];
        by_task_[task] = table_.add(law.at, law.probability);
    }
    return by_task_[task];
}

}  // namespace relax
