#include "relax/analysis/tdg_bound.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

namespace relax {

namespace {

// By TaskId: the methods with that subtask, once for each time they have it.
class Occurrences {
public:
    Occurrences(const GroundProblem& problem, Limits& limits) : ends_(problem.task_count() + 1, 0) {
        for (const MethodId method : problem.methods()) {
            limits.stop_if_reached();
            for (const TaskId subtask : problem.method_subtasks[method]) {
                ++ends_[subtask + 1];
            }
        }
        std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
        methods_.resize(ends_.back());
        std::vector<std::size_t> next(ends_.begin(), ends_.end() - 1);
        for (const MethodId method : problem.methods()) {
            limits.stop_if_reached();
            for (const TaskId subtask : problem.method_subtasks[method]) {
                methods_[next[subtask]++] = method;
            }
        }
    }

    std::span<const MethodId> operator[](TaskId task) const {
        return std::span(methods_).subspan(ends_[task], ends_[task + 1] - ends_[task]);
    }

private:
    std::vector<std::size_t> ends_;  // where the rows end, after where the first one begins
    std::vector<MethodId> methods_;
};

}  // namespace

std::vector<Cost> tdg_bound(const GroundProblem& problem, std::span<const Cost> costs, Limits& limits) {
    std::vector<Cost> bound(problem.task_count(), kInfinity);
    const Occurrences methods_with(problem, limits);
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
            if (--missing[method] == 0) {
                offer(problem.method_task[method], sum[method]);
            }
        }
    }
    return bound;
}

}  // namespace relax
