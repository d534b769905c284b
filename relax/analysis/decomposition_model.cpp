#include "relax/analysis/decomposition_model.hpp"

#include <utility>

#include "relax/base/cost.hpp"
#include "relaxed_model_builder.hpp"

namespace relax {

namespace {

// By MethodId: what the subtasks' bounds add up to beyond the task's.
std::vector<Cost> slacks(const GroundProblem& problem, std::span<const Cost> task_bounds) {
    std::vector<Cost> slacks;
    for (const MethodId method : problem.methods()) {
        Cost sum = 0;
        for (const TaskId subtask : problem.method_subtasks[method]) {
            sum = add_bounds(sum, task_bounds[subtask]);
        }
        slacks.push_back(sum - task_bounds[problem.method_task[method]]);
    }
    return slacks;
}

void add_decomposition(RelaxedModelBuilder& builder, const GroundProblem& problem, MethodId method) {
    const RelaxedModel& model = builder.model;
    const TaskId task = problem.method_task[method];
    const auto subtasks = problem.method_subtasks[method];
    const bool costs = model.owner_cost[method] > 0;
    const OwnerId owner = costs ? method : builder.free_owner();
    if (subtasks.empty()) {
        builder.add_operator({model.may_start(task)}, {model.reached(task)}, owner);
        return;
    }
    std::vector<std::vector<RelaxedFact>> earlier(subtasks.size());
    for (const auto& [first, then] : problem.method_ordering[method]) {
        earlier[then].push_back(model.reached(subtasks[first]));
    }
    // Where entering is free, the task may start, and that is all there is to it.
    const RelaxedFact entered = costs ? builder.add_fact() : model.may_start(task);
    std::vector<RelaxedFact> first;
    std::vector<RelaxedFact> all;
    if (costs) {
        first.push_back(entered);
        all.push_back(entered);
    }
    for (std::size_t at = 0; at < subtasks.size(); ++at) {
        all.push_back(model.reached(subtasks[at]));
        if (earlier[at].empty()) {
            first.push_back(model.may_start(subtasks[at]));
        }
    }
    builder.add_operator({model.may_start(task)}, std::move(first), owner);
    for (std::size_t at = 0; at < subtasks.size(); ++at) {
        if (!earlier[at].empty()) {
            earlier[at].push_back(entered);
            builder.add_operator(std::move(earlier[at]), {model.may_start(subtasks[at])}, builder.free_owner());
        }
    }
    builder.add_operator(std::move(all), {model.reached(task)}, builder.free_owner());
}

}  // namespace

RelaxedModel decomposition_model(const GroundProblem& problem, std::span<const Cost> task_bounds,
                                 std::span<const Cost> part_prices, Limits& limits) {
    RelaxedModelBuilder builder(problem, slacks(problem, task_bounds), part_prices, limits);
    builder.add_starts();
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        builder.add_action(action, builder.free_owner());
    }
    for (const MethodId method : problem.methods()) {
        limits.stop_if_reached();
        add_decomposition(builder, problem, method);
    }
    return builder.finish(limits);
}

}  // namespace relax
