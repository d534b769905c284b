#include "relax/analysis/task_reads.hpp"

#include <algorithm>

#include "relax/base/bits.hpp"
#include "relax/base/rows.hpp"
#include "relax/base/strong_components.hpp"
#include "relax/problem/state.hpp"

namespace relax {

namespace {

constexpr std::uint32_t kUnvisited = static_cast<std::uint32_t>(-1);

}  // namespace

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

// Tasks that lead to each other read the same. What a component leads to is closed before it.
void TaskReads::find_components(const GroundProblem& problem, Limits& limits) {
    const auto first = static_cast<std::uint32_t>(problem.action_count());
    Rows<std::uint32_t> below;  // by compound task: the compound tasks in its methods
    for (const TaskId task : problem.compounds()) {
        for (const MethodId method : problem.methods_of(task)) {
            limits.stop_if_reached();
            for (const TaskId subtask : problem.method_subtasks[method]) {
                if (!problem.is_primitive(subtask)) {
                    below.push(subtask - first);
                }
            }
        }
        below.finish_row();
    }
    std::vector<TaskId> members;
    StrongComponents().find(
        static_cast<std::uint32_t>(problem.compound_count()),
        [&](std::uint32_t compound) {
            limits.stop_if_reached();
            return below[compound];
        },
        [&](std::span<const std::uint32_t> compounds) {
            members.clear();
            for (const std::uint32_t compound : compounds) {
                members.emplace_back(first + compound);
            }
            close_component(problem, members, limits);
        });
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
