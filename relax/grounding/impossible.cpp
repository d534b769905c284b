#include "impossible.hpp"

#include <algorithm>
#include <memory>
#include <ranges>
#include <utility>
#include <vector>

#include "relax/analysis/mutexes.hpp"
#include "relax/analysis/tdg_bound.hpp"
#include "relax/base/cost.hpp"

namespace relax::grounding {

namespace {

// Which tasks and methods are of use.
class Living {
public:
    Living(const GroundProblem& problem, const Mutexes& mutexes, Limits& limits)
        : problem_(problem), limits_(limits), is_task_alive_(problem.task_count(), false) {
        find_needed(mutexes);
    }

    bool is_alive(TaskId task) const { return is_task_alive_[task]; }
    bool is_method_alive(MethodId method) const {
        return is_alive(problem_.method_task[method]) &&
               std::ranges::all_of(problem_.method_subtasks[method], [this](TaskId task) { return is_alive(task); });
    }

private:
    // From the initial task through methods of which all subtasks have a decomposition into possible actions.
    void find_needed(const Mutexes& mutexes) {
        std::vector<Cost> costs;  // infinite for what cannot be executed: so is then the bound of what needs it
        for (const ActionId action : problem_.actions()) {
            costs.push_back(mutexes.is_possible(action) ? 0 : kInfinity);
        }
        const std::vector<Cost> bounds = tdg_bound(problem_, costs, limits_);
        const auto has_decomposition = [&](TaskId task) { return bounds[task] < kInfinity; };
        if (has_decomposition(problem_.initial_task)) {
            wake(problem_.initial_task);
        }
        while (!pending_.empty()) {
            limits_.stop_if_reached();
            const TaskId task = pending_.back();
            pending_.pop_back();
            if (problem_.is_primitive(task)) {
                continue;
            }
            for (const MethodId method : problem_.methods_of(task)) {
                const auto subtasks = problem_.method_subtasks[method];
                if (std::ranges::all_of(subtasks, has_decomposition)) {
                    std::ranges::for_each(subtasks, [this](TaskId subtask) { wake(subtask); });
                }
            }
        }
    }

    void wake(TaskId task) {
        if (!is_task_alive_[task]) {
            is_task_alive_[task] = true;
            pending_.push_back(task);
        }
    }

    const GroundProblem& problem_;
    Limits& limits_;
    std::vector<bool> is_task_alive_;
    std::vector<TaskId> pending_;
};

// A copy of a ground problem with what lives. Facts keep their numbers.
class Copy {
public:
    Copy(const GroundProblem& old, const Living& living, Limits& limits)
        : old_(old), living_(living), limits_(limits), number_of_task_(old.task_count()) {}

    GroundProblem run() {
        copy_.fact_predicate = old_.fact_predicate;
        copy_.fact_arguments = old_.fact_arguments;
        copy_.initial_state = old_.initial_state;
        copy_actions();
        copy_compounds();
        copy_methods();
        copy_.initial_task = number_of_task_[old_.initial_task];
        return std::move(copy_);
    }

private:
    void copy_actions() {
        for (const ActionId action : old_.actions()) {
            limits_.stop_if_reached();
            if (!living_.is_alive(task_of(action))) {
                continue;
            }
            number_of_task_[action] = static_cast<TaskId>(copy_.action_count());
            copy_.preconditions.add_row(old_.preconditions[action]);
            copy_.negative_preconditions.add_row(old_.negative_preconditions[action]);
            copy_.action_schema.push_back(old_.action_schema[action]);
            copy_.action_arguments.add_row(old_.action_arguments[action]);
            copy_.action_cost_blocks.add_row(old_.action_cost_blocks[action]);
            copy_.action_branches.add_row(old_.action_branches[action]);
            for (const EffectId effect : old_.effects[action]) {
                copy_.effect_conditions.add_row(old_.effect_conditions[effect]);
                copy_.effect_negative_conditions.add_row(old_.effect_negative_conditions[effect]);
                copy_.effect_adds.add_row(old_.effect_adds[effect]);
                copy_.effect_deletes.add_row(old_.effect_deletes[effect]);
            }
            copy_.effects.share_out(copy_.effect_adds.size());
            for (const CostPartId part : old_.cost_parts[action]) {
                copy_.cost_part_blocks.add_row(old_.cost_part_blocks[part]);
                for (const AlternativeId alternative : old_.cost_alternatives[part]) {
                    copy_.cost_conditions.add_row(old_.cost_conditions[alternative]);
                    copy_.cost_negative_conditions.add_row(old_.cost_negative_conditions[alternative]);
                }
                copy_.cost_alternatives.share_out(copy_.cost_conditions.size());
            }
            copy_.cost_parts.share_out(copy_.cost_part_count());
        }
    }

    void copy_compounds() {
        for (const TaskId task : old_.compounds()) {
            if (living_.is_alive(task)) {
                number_of_task_[task] = static_cast<TaskId>(copy_.task_count());
                copy_.compound_schema.push_back(old_.compound_schema[task - old_.action_count()]);
                copy_.compound_is_chance.push_back(old_.is_chance(task));
                copy_.compound_arguments.add_row(old_.compound_arguments[task - old_.action_count()]);
            }
        }
    }

    void copy_methods() {
        std::vector<std::optional<MethodId>> number(old_.method_count());
        for (const MethodId method : old_.methods()) {
            limits_.stop_if_reached();
            if (!living_.is_method_alive(method)) {
                continue;
            }
            number[method] = static_cast<MethodId>(copy_.method_count());
            copy_.method_task.push_back(number_of_task_[old_.method_task[method]]);
            for (const TaskId subtask : old_.method_subtasks[method]) {
                copy_.method_subtasks.push(number_of_task_[subtask]);
            }
            copy_.method_subtasks.finish_row();
            copy_.method_positions.add_row(old_.method_positions[method]);
            copy_.method_ordering.add_row(old_.method_ordering[method]);
            for (const PartId part : old_.method_parts[method]) {
                copy_.part_schema.push_back(old_.part_schema[part]);
                copy_.part_arguments.add_row(old_.part_arguments[part]);
                copy_.part_origin.push_back(old_.part_origin[part]);
            }
            copy_.method_parts.share_out(copy_.part_schema.size());
        }
        for (const TaskId task : old_.compounds()) {
            if (living_.is_alive(task)) {
                for (const MethodId method : old_.methods_of(task)) {
                    if (number[method]) {
                        copy_.compound_methods.push(*number[method]);
                    }
                }
                copy_.compound_methods.finish_row();
            }
        }
    }

    const GroundProblem& old_;
    const Living& living_;
    Limits& limits_;
    std::vector<TaskId> number_of_task_;
    GroundProblem copy_;
};

}  // namespace

std::unique_ptr<AnalysedProblem> without_impossible(GroundProblem problem, Limits& limits) {
    auto mutexes = std::make_unique<const Mutexes>(problem, limits);
    if (!std::ranges::all_of(problem.actions(), [&](ActionId action) { return mutexes->is_possible(action); })) {
        const Living living(problem, *mutexes, limits);
        problem.solvable = living.is_alive(problem.initial_task);
        if (problem.solvable) {
            problem = Copy(problem, living, limits).run();
        }
    }
    return std::make_unique<AnalysedProblem>(std::move(problem), std::move(mutexes));
}

}  // namespace relax::grounding
