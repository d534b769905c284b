#include "relax/progression.hpp"

#include <utility>

namespace relax {

namespace {

std::optional<ActionId> first_action(const GroundProblem& problem, MethodId method) {
    const auto subtasks = problem.method_subtasks[method];
    std::vector<std::uint32_t> successors(subtasks.size(), 0);
    for (const auto& [earlier, later] : problem.method_ordering[method]) {
        ++successors[earlier];
    }
    for (std::size_t at = 0; at < subtasks.size(); ++at) {
        if (successors[at] + 1 == subtasks.size() && problem.is_primitive(subtasks[at])) {
            return subtasks[at];
        }
    }
    return std::nullopt;
}

}  // namespace

Progression::Progression(const GroundProblem& problem, std::vector<Cost> costs, std::vector<Cost> task_bounds,
                         bool skip_dead_methods, bool use_stubborn_sets)
    : problem_(problem),
      costs_(std::move(costs)),
      transition_(problem),
      states_(transition_.word_count()),
      networks_(make_task_networks(problem, std::move(task_bounds))),
      next_(transition_.word_count()) {
    if (use_stubborn_sets) {
        stubborn_set_.emplace(problem);
    }
    if (skip_dead_methods) {
        for (MethodId method = 0; method < problem.method_count(); ++method) {
            first_action_.push_back(first_action(problem, method));
        }
    }
}

StateId Progression::initial_state() { return states_.intern(transition_.initial_state()); }

void Progression::expand(StateId state, NetworkId network, std::vector<Successor>& successors) {
    successors.clear();
    unconstrained_.clear();
    networks_->unconstrained(network, unconstrained_);
    if (const auto compound = compound_to_decompose()) {
        const bool comes_next = !first_action_.empty() && unconstrained_.size() == 1;
        for (const MethodId method : problem_.methods_of(compound->task)) {
            if (comes_next && first_action_[method] &&
                !transition_.is_applicable(*first_action_[method], states_[state])) {
                continue;
            }
            const NetworkId next = networks_->decompose(network, compound->index, method);
            successors.push_back({state, next, 0, {compound->index, method}});
        }
        return;
    }
    for (const Occurrence& occurrence : unconstrained_) {
        if (costs_[occurrence.task] == 0 && transition_.has_no_effect(occurrence.task) && may_hurry(occurrence.task) &&
            transition_.is_applicable(occurrence.task, states_[state])) {
            successors.push_back(execute(state, network, occurrence));
            return;
        }
    }
    if (stubborn_set_ && unconstrained_.size() > 1) {
        networks_->ordered_tasks(network, ordered_tasks_);
        stubborn_set_->reduce(ordered_tasks_, states_[state], unconstrained_);
    }
    for (const Occurrence& occurrence : unconstrained_) {
        if (transition_.is_applicable(occurrence.task, states_[state])) {
            successors.push_back(execute(state, network, occurrence));
        }
    }
}

// The unconstrained compound task with the fewest methods, the first one among equals.
std::optional<Occurrence> Progression::compound_to_decompose() const {
    std::optional<Occurrence> best;
    std::size_t fewest = 0;
    for (const Occurrence& occurrence : unconstrained_) {
        if (!problem_.is_primitive(occurrence.task)) {
            const std::size_t count = problem_.methods_of(occurrence.task).size();
            if (!best || count < fewest) {
                best = occurrence;
                fewest = count;
            }
        }
    }
    return best;
}

Successor Progression::execute(StateId state, NetworkId network, const Occurrence& occurrence) {
    transition_.apply(occurrence.task, states_[state], next_);
    return {states_.intern(next_),
            networks_->progress(network, occurrence.index),
            costs_[occurrence.task],
            {occurrence.index, std::nullopt}};
}

}  // namespace relax
