#include "relax/tdg_bound.hpp"

#include <functional>
#include <queue>
#include <utility>

namespace relax {

std::vector<Cost> tdg_bound(const GroundProblem& problem, std::span<const Cost> costs) {
    std::vector<Cost> bound(problem.task_count(), kNoDecomposition);
    std::vector<std::vector<MethodId>> methods_with(problem.task_count());  // once for each occurrence of the task
    std::vector<std::size_t> missing(problem.method_count());               // subtasks that have no bound yet
    std::vector<Cost> sum(problem.method_count(), 0);
    std::priority_queue<std::pair<Cost, TaskId>, std::vector<std::pair<Cost, TaskId>>, std::greater<>> queue;

    const auto offer = [&](TaskId task, Cost value) {
        if (value < bound[task]) {
            bound[task] = value;
            queue.emplace(value, task);
        }
    };
    for (MethodId method = 0; method < problem.method_count(); ++method) {
        const auto subtasks = problem.method_subtasks[method];
        missing[method] = subtasks.size();
        for (const TaskId subtask : subtasks) {
            methods_with[subtask].push_back(method);
        }
        if (subtasks.empty()) {
            offer(problem.method_task[method], 0);
        }
    }
    for (ActionId action = 0; action < problem.action_count(); ++action) {
        offer(action, costs[action]);
    }
    while (!queue.empty()) {
        const auto [value, task] = queue.top();
        queue.pop();
        if (value != bound[task]) {
            continue;
        }
        for (const MethodId method : methods_with[task]) {
            sum[method] = add_bounds(sum[method], value);
            if (--missing[method] == 0) {
                offer(problem.method_task[method], sum[method]);
            }
        }
    }
    return bound;
}

}  // namespace relax
