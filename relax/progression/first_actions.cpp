#include "relax/progression/first_actions.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace relax {

namespace {

std::optional<ActionId> first_action(const AnalysedProblem& problem, MethodId method, bool in_sequence,
                                     Limits& limits) {
    const auto subtasks = problem.method_subtasks[method];
    const auto ordering = problem.method_ordering[method];
    std::size_t first = 0;  // if there is only one subtask
    if (in_sequence && subtasks.size() > 1) {
        first = problem.sequences(limits)[method].front();
    } else if (subtasks.size() > 1) {
        // The pairs are sorted: look for a run that has all the others.
        std::size_t run = 0;
        std::size_t at = 0;
        for (; at < ordering.size() && run + 1 < subtasks.size(); ++at) {
            run = at > 0 && ordering[at].first == ordering[at - 1].first ? run + 1 : 1;
        }
        if (run + 1 < subtasks.size()) {
            return std::nullopt;
        }
        first = ordering[at - 1].first;
    }
    if (subtasks.empty() || !(problem.is_primitive(subtasks[first]) || problem.is_chance(subtasks[first]))) {
        return std::nullopt;
    }
    return problem.any_outcome(subtasks[first]);
}

}  // namespace

FirstActions::FirstActions(const AnalysedProblem& problem, bool in_sequence, Limits& limits)
    : problem_(problem), transition_(problem) {
    actions_.reserve(problem.method_count());
    for (const MethodId method : problem.methods()) {
        limits.stop_if_reached();
        actions_.push_back(first_action(problem, method, in_sequence, limits));
    }
    groups_of_.resize(problem.compound_count(), kUngrouped);
}

std::vector<FirstActions::Group> FirstActions::grouped(std::span<const MethodId> methods) {
    needs_.resize(problem_.fact_count(), 0);
    const auto needed = [this](MethodId method) {
        return actions_[method] ? problem_.preconditions[*actions_[method]] : std::span<const FactId>{};
    };
    for (const MethodId method : methods) {
        for (const FactId fact : needed(method)) {
            ++needs_[fact];
        }
    }
    std::map<std::optional<FactId>, std::vector<MethodId>> found;
    for (const MethodId method : methods) {
        const auto facts = needed(method);
        const auto rarest = std::ranges::min_element(facts, {}, [this](FactId fact) { return needs_[fact]; });
        found[rarest == facts.end() ? std::nullopt : std::optional(*rarest)].push_back(method);
    }
    for (const MethodId method : methods) {
        for (const FactId fact : needed(method)) {
            needs_[fact] = 0;
        }
    }
    std::vector<Group> groups;
    for (auto& [fact, members] : found) {
        groups.push_back({fact, std::move(members)});
    }
    return groups;
}

void FirstActions::add_live(TaskId task, std::span<const std::uint64_t> state, std::vector<MethodId>& live) {
    const auto methods = problem_.methods_of(task);
    if (methods.size() <= kFew) {
        std::ranges::copy_if(methods, std::back_inserter(live),
                             [&](MethodId method) { return is_live(method, state); });
        return;
    }
    std::uint32_t& groups = groups_of_[task - problem_.action_count()];
    if (groups == kUngrouped) {
        groups = static_cast<std::uint32_t>(groups_.size());
        groups_.push_back(grouped(methods));
    }
    const auto begin = static_cast<std::ptrdiff_t>(live.size());
    for (const Group& group : groups_[groups]) {
        if (!group.needed || holds(state, *group.needed)) {
            std::ranges::copy_if(group.methods, std::back_inserter(live),
                                 [&](MethodId method) { return is_live(method, state); });
        }
    }
    std::sort(live.begin() + begin, live.end());
}

}  // namespace relax
