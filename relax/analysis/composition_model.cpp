#include "relax/analysis/composition_model.hpp"

#include <utility>

#include "relaxed_model_builder.hpp"

namespace relax {

namespace {

void add_composition(RelaxedModelBuilder& builder, const GroundProblem& problem, MethodId method) {
    RelaxedModel& model = builder.model;
    const auto row = problem.method_subtasks[method];
    std::vector<TaskId> subtasks(row.begin(), row.end());
    sort_unique(subtasks);
    std::vector<RelaxedFact> needed;
    for (const TaskId subtask : subtasks) {
        needed.push_back(model.reached(subtask));
    }
    model.method_operator[method] = static_cast<OperatorId>(model.operator_count());
    model.task_operators.push(model.method_operator[method]);
    model.operator_task.push_back(problem.method_task[method]);
    model.operator_subtasks.add_row(subtasks);
    builder.add_operator(std::move(needed), {model.reached(problem.method_task[method])}, builder.free_owner());
}

}  // namespace

RelaxedModel composition_model(const GroundProblem& problem, const Prices& prices, Limits& limits) {
    RelaxedModelBuilder builder(problem, prices.actions, prices.parts, limits);
    RelaxedModel& model = builder.model;
    model.first_settled = static_cast<RelaxedFact>(model.first_reached + problem.task_count());
    model.method_operator.resize(problem.method_count());
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        const auto first = static_cast<OperatorId>(model.operator_count());
        builder.add_action(action, action);
        for (OperatorId op = first; op < model.operator_count(); ++op) {
            model.task_operators.push(op);
            model.operator_task.push_back(task_of(action));
            model.operator_subtasks.finish_row();
        }
        model.task_operators.finish_row();
    }
    for (const TaskId task : problem.compounds()) {
        for (const MethodId method : problem.methods_of(task)) {
            limits.stop_if_reached();
            add_composition(builder, problem, method);
        }
        model.task_operators.finish_row();
    }
    return builder.finish(limits);
}

}  // namespace relax
