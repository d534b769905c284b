#include "relax/analysis/tdg_bound.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>

namespace relax {

std::vector<Cost> tdg_bound(const GroundProblem& problem, std::span<const Cost> costs, Limits& limits) {
    assert(costs.size() == problem.action_count());
    assert(std::ranges::all_of(costs, [](Cost cost) { return cost >= 0; }));
    std::vector<Cost> bound(problem.task_count(), kInfinity);
    const auto methods_with = invert(problem.method_subtasks, problem.task_count(), limits);
    std::vector<std::uint32_t> missing(problem.method_count());  // subtasks that have no bound yet
    std::vector<Cost> sum(problem.method_count(), 0);
    std::priority_queue<std::pair<Cost, TaskId>, std::vector<std::pair<Cost, TaskId>>, std::greater<>> queue;

    const auto offer = [&](TaskId task, Cost value) {
        if (value < bound[task]) {
            bound[task] = value;
            queue.emplace(value, task);
        }
    };
    for (const MethodId method : problem.methods()) {
        const auto subtasks = problem.method_subtasks[method];
        missing[method] = static_cast<std::uint32_t>(subtasks.size());
        if (subtasks.empty()) {
            offer(problem.method_task[method], 0);
        }
    }
    for (const ActionId action : problem.actions()) {
        offer(task_of(action), costs[action]);
    }
    while (!queue.empty()) {
        limits.stop_if_reached();
        const auto [value, task] = queue.top();
        queue.pop();
        if (value != bound[task]) {
            continue;
        }
        for (const MethodId method : methods_with[task]) {
            sum[method] = add_bounds(sum[method], value);
            assert(missing[method] > 0);
            if (--missing[method] == 0) {
                offer(problem.method_task[method], sum[method]);
            }
        }
    }
    return bound;
}

}  // namespace relax
