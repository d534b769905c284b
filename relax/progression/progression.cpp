#include "relax/progression/progression.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace relax {

Progression::Progression(const AnalysedProblem& problem, const std::vector<bool>& free_actions,
                         const ProgressionOptions& options, Limits& limits)
    : problem_(problem),
      transition_(problem),
      states_(transition_.word_count()),
      networks_(make_task_networks(problem, options.use_macros, options.in_sequence, limits)),
      branching_(problem),
      next_(transition_.word_count()),
      waits_until_due_(options.when_due && options.skip_dead_methods) {
    for (const ActionId action : problem.actions()) {
        is_executed_at_once_.push_back(free_actions[action] && transition_.has_no_effect(action));
    }
    if (options.stubborn_sets) {
        stubborn_set_.emplace(problem, limits);
    }
    if (options.forget_facts) {
        relevant_facts_.emplace(problem, limits);
    }
    if (options.forget_unreachable) {
        reduced_states_.emplace(problem, limits);
    }
    if (options.skip_dead_methods) {
        first_actions_.emplace(problem, options.in_sequence, limits);
    }
}

StateId Progression::initial_state() {
    next_ = transition_.initial_state();
    return keep_relevant(initial_network());
}

void Progression::expand(StateId state, NetworkId network, std::vector<Successor>& successors) {
    if (waits_until_due_) {
        expand_when_due(state, network, successors);
        return;
    }
    if (expand_if_forced(state, network, successors)) {
        return;
    }
    for (const MethodId method : live_methods_) {
        successors.push_back(decompose(state, network, *compound_, method));
    }
    for (const Occurrence& occurrence : to_execute_) {
        successors.push_back(execute(state, network, occurrence));
    }
}

// The successors where a method with a first action is not applied before that can be executed. No plan is lost: its
// decompositions can be made as late as that, when the action is applicable and the task unconstrained.
void Progression::expand_when_due(StateId state, NetworkId network, std::vector<Successor>& successors) {
    if (execute_at_once(state, network, successors) || decompose_at_once(state, network, successors)) {
        return;
    }
    for (const Occurrence& occurrence : unconstrained_) {
        if (problem_.is_primitive(occurrence.task)) {
            if (transition_.is_applicable(problem_.action_of(occurrence.task), states_[state])) {
                successors.push_back(execute(state, network, occurrence));
            }
            continue;
        }
        live_methods_.clear();
        first_actions_->add_live(occurrence.task, states_[state], live_methods_);
        for (const MethodId method : live_methods_) {
            successors.push_back(decompose(state, network, occurrence, method));
        }
    }
}

// Decompose an unconstrained task of whose methods none has a first action, if there is one: it may come first in any
// plan.
bool Progression::decompose_at_once(StateId state, NetworkId network, std::vector<Successor>& successors) {
    const auto found = std::ranges::find_if(unconstrained_, [this](const Occurrence& occurrence) {
        return !problem_.is_primitive(occurrence.task) &&
               std::ranges::none_of(problem_.methods_of(occurrence.task),
                                    [this](MethodId method) { return (*first_actions_)[method].has_value(); });
    });
    if (found == unconstrained_.end()) {
        return false;
    }
    for (const MethodId method : problem_.methods_of(found->task)) {
        successors.push_back(decompose(state, network, *found, method));
    }
    return true;
}

// List the node's unconstrained tasks. If one is an applicable action that costs and changes nothing, make its
// execution the only successor.
bool Progression::execute_at_once(StateId state, NetworkId network, std::vector<Successor>& successors) {
    successors.clear();
    unconstrained_.clear();
    networks_->unconstrained(network, unconstrained_);
    work_ += unconstrained_.size();
    for (const Occurrence& occurrence : unconstrained_) {
        if (is_executed_at_once(occurrence.task) &&
            transition_.is_applicable(problem_.action_of(occurrence.task), states_[state])) {
            successors.push_back(execute(state, network, occurrence));
            return true;
        }
    }
    return false;
}

bool Progression::expand_if_forced(StateId state, NetworkId network, std::vector<Successor>& successors) {
    live_methods_.clear();
    to_execute_.clear();
    if (execute_at_once(state, network, successors)) {
        return true;
    }
    compound_ = compound_to_decompose();
    if (compound_) {
        find_live_methods(state);
    }
    choose_actions(state, network);
    if (live_methods_.size() + to_execute_.size() > 1) {
        return false;
    }
    if (!live_methods_.empty()) {
        successors.push_back(decompose(state, network, *compound_, live_methods_.front()));
    } else if (!to_execute_.empty()) {
        successors.push_back(execute(state, network, to_execute_.front()));
    }
    return true;
}

// Execute the actions of a stubborn set instead of decomposing, if they are no more than the methods.
void Progression::choose_actions(StateId state, NetworkId network) {
    const bool has_actions = std::ranges::any_of(
        unconstrained_, [this](const Occurrence& occurrence) { return problem_.is_primitive(occurrence.task); });
    if (!has_actions || (compound_ && live_methods_.size() <= 1)) {
        return;
    }
    if (stubborn_set_ && unconstrained_.size() > 1) {
        const auto found = stubborn_set_->find(ordered_tasks(network), states_[state], unconstrained_);
        if (found && (!compound_ || found->size() <= live_methods_.size())) {
            live_methods_.clear();
            to_execute_.assign(found->begin(), found->end());
        }
    } else if (!compound_) {
        std::ranges::copy_if(unconstrained_, std::back_inserter(to_execute_), [&](const Occurrence& occurrence) {
            return transition_.is_applicable(problem_.action_of(occurrence.task), states_[state]);
        });
    }
}

void Progression::add_methods(TaskId task, bool comes_next, StateId state, std::vector<MethodId>& methods) {
    if (comes_next && first_actions_) {
        first_actions_->add_live(task, states_[state], methods);
        return;
    }
    const auto all = problem_.methods_of(task);
    methods.insert(methods.end(), all.begin(), all.end());
}

void Progression::find_live_methods(StateId state) {
    add_methods(compound_->task, unconstrained_.size() == 1, state, live_methods_);
}

NodeView Progression::view(StateId state, NetworkId network) {
    if (!networks_->are_totally_ordered()) {
        ordered_tasks(network);
        return {states_[state], ordered_tasks_.tasks, false, ordered_tasks_.predecessors};
    }
    ordered_tasks_.tasks.clear();
    networks_->tasks(network, ordered_tasks_.tasks);
    work_ += ordered_tasks_.tasks.size();
    return {states_[state], ordered_tasks_.tasks, true};
}

// The first one of the best unconstrained compound tasks.
std::optional<Occurrence> Progression::compound_to_decompose() const {
    std::optional<Occurrence> best;
    double fewest = 0;
    for (const Occurrence& occurrence : unconstrained_) {
        if (!problem_.is_primitive(occurrence.task)) {
            const double survivors = branching_.expect_survivors(occurrence.task);
            if (!best || survivors < fewest) {
                best = occurrence;
                fewest = survivors;
            }
        }
    }
    return best;
}

Successor Progression::decompose(StateId state, NetworkId network, const Occurrence& occurrence, MethodId method) {
    assert(problem_.method_task[method] == occurrence.task);
    const NetworkId next = networks_->decompose(network, occurrence.index, method);
    if (relevant_facts_) {
        std::ranges::copy(states_[state], next_.begin());
        state = keep_relevant(next);
    }
    return {state, next, {occurrence.index, method}, std::nullopt, {}};
}

Successor Progression::execute(StateId state, NetworkId network, const Occurrence& occurrence, ActionId action) {
    std::vector<CostPartId> due_parts;
    for (const CostPartId part : problem_.cost_parts[action]) {
        if (transition_.is_due(part, states_[state])) {
            due_parts.push_back(part);
        }
    }
    transition_.apply(action, states_[state], next_);
    const NetworkId next = networks_->progress(network, occurrence.index);
    return {keep_relevant(next), next, {occurrence.index, std::nullopt}, action, std::move(due_parts)};
}

// Returns the state of the facts in `next_`, as far as they matter to the network.
StateId Progression::keep_relevant(NetworkId network) {
    if (relevant_facts_) {
        keep_common(next_, relevant_facts_->of(*networks_, network));
        work_ += networks_->are_totally_ordered() ? 0 : networks_->size(network);
    }
    const StateId state = states_.intern(next_);
    return reduced_states_ ? reduced_states_->of(state, states_) : state;
}

StateBits Progression::facts_that_matter(StateId state, NetworkId network) {
    StateBits facts(next_.size(), 0);
    for (const FactId fact : problem_.facts()) {
        set_bit(facts, fact);
    }
    if (relevant_facts_) {
        keep_common(facts, relevant_facts_->of(*networks_, network));
    }
    if (reduced_states_) {
        keep_common(facts, reduced_states_->facts_that_matter(states_[state]));
    }
    return facts;
}

}  // namespace relax
