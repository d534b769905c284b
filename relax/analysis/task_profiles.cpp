#include "relax/analysis/task_profiles.hpp"

#include <algorithm>
#include <iterator>

namespace relax {

const TaskProfile& TaskProfiles::of(TaskId task, Limits& limits) const {
    return profiles_[task].get([&] {
        return problem_.is_primitive(task) ? of_action(problem_.action_of(task))
               : problem_.is_chance(task)  ? of_chance(task, limits)
                                           : of_compound(task, limits);
    });
}

TaskProfile TaskProfiles::of_action(ActionId action) const {
    TaskProfile result = TaskProfile::empty(problem_);
    for (const FactId fact : problem_.preconditions[action]) {
        result.preconditions.push_back(literal_of(fact));
    }
    for (const FactId fact : problem_.negative_preconditions[action]) {
        result.preconditions.push_back(literal_of(fact, true));
    }
    result.read_list = result.preconditions;
    const auto read_either_way = [&result](std::span<const FactId> facts) {
        for (const FactId fact : facts) {
            result.read_list.push_back(literal_of(fact));
            result.read_list.push_back(literal_of(fact, true));
        }
    };
    for (const CostPartId part : problem_.cost_parts[action]) {
        for (const AlternativeId alternative : problem_.cost_alternatives[part]) {
            read_either_way(problem_.cost_conditions[alternative]);
            read_either_way(problem_.cost_negative_conditions[alternative]);
        }
    }
    for (const EffectId effect : problem_.effects[action]) {
        read_either_way(problem_.effect_conditions[effect]);
        read_either_way(problem_.effect_negative_conditions[effect]);
        const bool is_certain = problem_.is_unconditional(effect);
        const auto make = [&](Literal literal) {
            result.made_list.push_back(literal);
            if (is_certain) {
                result.undoes.insert(negation(literal));
            }
        };
        for (const FactId fact : problem_.effect_adds[effect]) {
            make(literal_of(fact));
        }
        for (const FactId fact : problem_.effect_deletes[effect]) {
            make(literal_of(fact, true));
        }
    }
    for (const Literal literal : result.read_list) {
        result.reads.insert(literal);
    }
    for (const Literal literal : result.made_list) {
        result.makes.insert(literal);
        if (!is_negated(literal)) {
            result.undoes.erase(literal);  // adding wins over deleting
        }
    }
    return result;
}

// All of its outcomes together.
TaskProfile TaskProfiles::of_chance(TaskId task, Limits& limits) const {
    TaskProfile result = of_compound(task, limits);
    const auto list = [](const std::vector<Literal>& literals, Literals listed, std::vector<Literal>& into) {
        for (const Literal literal : into) {
            listed.erase(literal);
        }
        std::ranges::copy_if(literals, std::back_inserter(into), [&](Literal literal) {
            const bool is_new = listed.contains(literal);
            listed.erase(literal);
            return is_new;
        });
    };
    for (const MethodId method : problem_.methods_of(task)) {
        const TaskProfile& outcome = of(task_of(problem_.outcome_action(method)), limits);
        result.preconditions = outcome.preconditions;
        list(outcome.read_list, result.reads, result.read_list);
        list(outcome.made_list, result.makes, result.made_list);
    }
    return result;
}

TaskProfile TaskProfiles::of_compound(TaskId task, Limits& limits) const {
    TaskProfile result = TaskProfile::empty(problem_);
    std::vector<bool> is_seen(problem_.task_count(), false);
    std::vector<TaskId> pending{task};
    is_seen[task] = true;
    while (!pending.empty()) {
        limits.stop_if_reached();
        const TaskId next = pending.back();
        pending.pop_back();
        if (problem_.is_primitive(next) || profiles_[next].is_made()) {
            const TaskProfile& known = of(next, limits);
            result.reads.insert_all(known.reads);
            result.makes.insert_all(known.makes);
            continue;
        }
        for (const MethodId method : problem_.methods_of(next)) {
            for (const TaskId subtask : problem_.method_subtasks[method]) {
                if (!is_seen[subtask]) {
                    is_seen[subtask] = true;
                    pending.push_back(subtask);
                }
            }
        }
    }
    return result;
}

}  // namespace relax
