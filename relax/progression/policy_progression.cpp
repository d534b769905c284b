#include "relax/progression/policy_progression.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

namespace relax {

namespace {

// By TaskId: see PolicyProgression.
std::vector<bool> uncertain_tasks(const GroundProblem& problem, const SeenCosts& seen, Limits& limits) {
    std::vector<bool> is_uncertain(problem.task_count(), false);
    std::vector<TaskId> pending;
    const auto mark = [&](TaskId task) {
        if (!is_uncertain[task]) {
            is_uncertain[task] = true;
            pending.push_back(task);
        }
    };
    for (const TaskId task : problem.compounds()) {
        if (problem.is_chance(task)) {
            mark(task);
        }
    }
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        const bool is_seen = !seen.actions.empty() && seen.actions[action];
        if (is_seen || std::ranges::any_of(problem.cost_parts[action],
                                           [&](CostPartId part) { return !seen.parts.empty() && seen.parts[part]; })) {
            mark(task_of(action));
        }
    }
    const Rows<MethodId, TaskId> users = invert(problem.method_subtasks, problem.task_count(), limits);
    while (!pending.empty()) {
        limits.stop_if_reached();
        const TaskId task = pending.back();
        pending.pop_back();
        for (const MethodId method : users[task]) {
            mark(problem.method_task[method]);
        }
    }
    return is_uncertain;
}

ProgressionOptions progression_options(const PolicySwitches& switches) {
    ProgressionOptions options;
    options.skip_dead_methods = switches.skip_dead_methods;
    options.stubborn_sets = false;  // there is one here
    options.forget_facts = switches.forget_facts;
    options.forget_unreachable = switches.forget_unreachable;
    return options;
}

}  // namespace

PolicyProgression::PolicyProgression(const AnalysedProblem& problem, const std::vector<bool>& free_actions,
                                     const SeenCosts& seen, const PolicyOptions& options, Limits& limits)
    : problem_(problem),
      transition_(problem),
      progression_(problem, free_actions, progression_options(options), limits),
      heeding_{uncertain_tasks(problem, seen, limits), std::nullopt},
      uses_lone_members_(options.lone_members),
      only_done_runs_pay_(options.only_done_runs_pay) {
    if (!seen.actions.empty() || !seen.parts.empty()) {
        heedless_.emplace(uncertain_tasks(problem, {}, limits), std::nullopt);
    }
    if (options.stubborn_sets) {
        heeding_.stubborn_set.emplace(problem, limits, &heeding_.is_uncertain);
        if (heedless_) {
            heedless_->stubborn_set.emplace(problem, limits, &heedless_->is_uncertain);
        }
    }
}

void PolicyProgression::decisions(StateId state, NetworkId network, std::vector<PolicyDecision>& decisions,
                                  bool heeds_costs) {
    branching_ = heeds_costs || !heedless_ ? &heeding_ : &*heedless_;
    decisions.clear();
    unconstrained_.clear();
    networks().unconstrained(network, unconstrained_);
    choose(state, network);
    for (const Occurrence& occurrence : chosen_) {
        add_decisions(state, network, occurrence, decisions);
    }
}

// Whether the task may be the only one that is tried, whatever else is unconstrained.
bool PolicyProgression::is_first(const Occurrence& occurrence, StateId state) const {
    if (problem_.is_primitive(occurrence.task)) {
        return progression_.is_executed_at_once(occurrence.task) && is_applicable(occurrence, state);
    }
    return !problem_.is_chance(occurrence.task) && problem_.methods_of(occurrence.task).size() == 1;
}

// Choose the tasks to try.
void PolicyProgression::choose(StateId state, NetworkId network) {
    chosen_.clear();
    const auto first =
        std::ranges::find_if(unconstrained_, [&](const Occurrence& occurrence) { return is_first(occurrence, state); });
    if (first != unconstrained_.end()) {
        chosen_.push_back(*first);
        return;
    }
    std::optional<StubbornSet>& stubborn_set = branching_->stubborn_set;
    if (!stubborn_set || unconstrained_.size() <= 1) {
        chosen_ = unconstrained_;
        return;
    }
    const OrderedTasks& ordered = ordered_tasks(network);
    find_uncertain(ordered);
    if (uses_lone_members_ && !uncertain_.empty() && choose_lone_member(state, ordered)) {
        return;
    }
    const std::optional<Occurrence> compound = compound_to_decompose(ordered);
    const auto actions = stubborn_set->find(ordered, states()[state], unconstrained_);
    if (actions && (!compound || actions->size() <= problem_.methods_of(compound->task).size())) {
        chosen_.assign(actions->begin(), actions->end());
    } else if (compound) {
        chosen_.push_back(*compound);
    } else {
        chosen_ = unconstrained_;
    }
}

void PolicyProgression::find_uncertain(const OrderedTasks& ordered) {
    uncertain_.clear();
    for (std::uint32_t index = 0; index < ordered.tasks.size(); ++index) {
        if (branching_->is_uncertain[ordered.tasks[index]]) {
            uncertain_.push_back(index);
        }
    }
}

// Rule (3). False where it says nothing.
bool PolicyProgression::choose_lone_member(StateId state, const OrderedTasks& ordered) {
    const auto actions = branching_->stubborn_set->find(ordered, states()[state], unconstrained_, false);
    if (!actions || actions->size() > (only_done_runs_pay_ ? 1 : 0)) {
        return false;
    }
    chosen_.assign(actions->begin(), actions->end());
    return true;
}

// The compound task with the fewest methods of those whose decomposition waits for nothing.
std::optional<Occurrence> PolicyProgression::compound_to_decompose(const OrderedTasks& ordered) const {
    std::optional<Occurrence> best;
    for (const Occurrence& occurrence : unconstrained_) {
        const bool waits = is_action(occurrence.task) || std::ranges::any_of(uncertain_, [&](std::uint32_t other) {
                               return other != occurrence.index && !ordered.is_before(occurrence.index, other);
                           });
        if (!waits && (!best || problem_.methods_of(occurrence.task).size() < problem_.methods_of(best->task).size())) {
            best = occurrence;
        }
    }
    return best;
}

void PolicyProgression::add_decisions(StateId state, NetworkId network, const Occurrence& occurrence,
                                      std::vector<PolicyDecision>& decisions) {
    const auto outcome_of = [](Successor successor) {
        return PolicyOutcome{successor.state, successor.network, successor.action, std::move(successor.due_parts)};
    };
    if (is_action(occurrence.task)) {
        if (!is_applicable(occurrence, state)) {
            return;
        }
        PolicyDecision& decision = decisions.emplace_back();
        decision.step = {occurrence.index, std::nullopt};
        if (problem_.is_primitive(occurrence.task)) {
            decision.outcomes.push_back(
                outcome_of(progression_.execute(state, network, occurrence, problem_.action_of(occurrence.task))));
            return;
        }
        for (const MethodId method : problem_.methods_of(occurrence.task)) {
            decision.outcomes.push_back(
                outcome_of(progression_.execute(state, network, occurrence, problem_.outcome_action(method))));
        }
        return;
    }
    methods_.clear();
    progression_.add_methods(occurrence.task, unconstrained_.size() == 1, state, methods_);
    for (const MethodId method : methods_) {
        PolicyDecision& decision = decisions.emplace_back();
        decision.step = {occurrence.index, method};
        decision.outcomes.push_back(outcome_of(progression_.decompose(state, network, occurrence, method)));
    }
}

}  // namespace relax
