#include "relax/analysis/task_reads.hpp"

#include <algorithm>

#include "relax/base/bits.hpp"
#include "relax/problem/state.hpp"

namespace relax {

namespace {

constexpr std::uint32_t kUnvisited = static_cast<std::uint32_t>(-1);

void add_reads(const GroundProblem& problem, ActionId action, std::span<std::uint64_t> mask) {
    const auto add = [mask](std::span<const FactId> facts) {
        for (const FactId fact : facts) {
            set_bit(mask, fact);
        }
    };
    add(problem.preconditions[action]);
    add(problem.negative_preconditions[action]);
    for (const EffectId effect : problem.effects[action]) {
        add(problem.effect_conditions[effect]);
        add(problem.effect_negative_conditions[effect]);
    }
    for (const CostPartId part : problem.cost_parts[action]) {
        for (const AlternativeId alternative : problem.cost_alternatives[part]) {
            add(problem.cost_conditions[alternative]);
            add(problem.cost_negative_conditions[alternative]);
        }
    }
}

}  // namespace

TaskReads::TaskReads(const GroundProblem& problem, Limits& limits)
    : words_(words_for(problem.fact_count())), component_(problem.task_count(), kUnvisited) {
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        component_[action] = component_count_;
        add_reads(problem, action, add_component());
    }
    find_components(problem, limits);
}

std::span<std::uint64_t> TaskReads::add_component() {
    masks_.resize(++component_count_ * words_, 0);
    return std::span(masks_).last(words_);
}

// Tarjan's algorithm (1972) without recursion: components are closed after all that they lead to.
void TaskReads::find_components(const GroundProblem& problem, Limits& limits) {
    struct Visit {
        TaskId task;
        std::uint32_t method;   // of the task's, the one looked at
        std::uint32_t subtask;  // of it, the next one to look at
    };
    std::vector<std::uint32_t> number(problem.task_count(), kUnvisited);
    std::vector<std::uint32_t> lowest(problem.task_count(), kUnvisited);
    std::vector<Visit> visits;
    std::vector<TaskId> stack;
    std::uint32_t next_number = 0;
    const auto enter = [&](TaskId task) {
        number[task] = lowest[task] = next_number++;
        stack.push_back(task);
        visits.push_back({task, 0, 0});
    };
    for (const TaskId root : problem.compounds()) {
        if (number[root] == kUnvisited) {
            enter(root);
        }
        while (!visits.empty()) {
            limits.stop_if_reached();
            Visit& visit = visits.back();
            const TaskId task = visit.task;
            const auto methods = problem.methods_of(task);
            if (visit.method < methods.size()) {
                const auto subtasks = problem.method_subtasks[methods[visit.method]];
                if (visit.subtask == subtasks.size()) {
                    ++visit.method;
                    visit.subtask = 0;
                    continue;
                }
                const TaskId subtask = subtasks[visit.subtask++];
                if (problem.is_primitive(subtask) || component_[subtask] != kUnvisited) {
                    continue;
                }
                if (number[subtask] == kUnvisited) {
                    enter(subtask);
                } else {
                    lowest[task] = std::min(lowest[task], number[subtask]);
                }
                continue;
            }
            visits.pop_back();
            if (!visits.empty()) {
                lowest[visits.back().task] = std::min(lowest[visits.back().task], lowest[task]);
            }
            if (lowest[task] == number[task]) {
                const auto first = std::ranges::find(stack, task);
                close_component(problem, std::span(first, stack.end()), limits);
                stack.erase(first, stack.end());
            }
        }
    }
}

void TaskReads::close_component(const GroundProblem& problem, std::span<const TaskId> members, Limits& limits) {
    for (const TaskId task : members) {
        component_[task] = component_count_;
    }
    const auto mask = add_component();
    for (const TaskId task : members) {
        for (const MethodId method : problem.methods_of(task)) {
            limits.stop_if_reached();
            for (const TaskId subtask : problem.method_subtasks[method]) {
                unite(mask, (*this)[subtask]);
            }
        }
    }
}

}  // namespace relax
