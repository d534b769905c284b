#include "relax/progression/relevant_facts.hpp"

#include <algorithm>

namespace relax {

namespace {

constexpr std::uint32_t kUnvisited = static_cast<std::uint32_t>(-1);

void unite(std::span<std::uint64_t> into, std::span<const std::uint64_t> other) {
    for (std::size_t word = 0; word < into.size(); ++word) {
        into[word] |= other[word];
    }
}

}  // namespace

RelevantFacts::RelevantFacts(const GroundProblem& problem, Limits& limits)
    : problem_(problem),
      limits_(limits),
      words_(words_for(problem.fact_count())),
      component_(problem.task_count(), kUnvisited),
      masks_(words_),
      mask_(words_) {
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        component_[action] = component_count_++;
        masks_of_components_.resize(component_count_ * words_, 0);
        add_reads(action);
    }
    find_components();
}

void RelevantFacts::add_reads(ActionId action) {
    const auto mask = std::span(masks_of_components_).last(words_);
    const auto add = [mask](std::span<const FactId> facts) {
        for (const FactId fact : facts) {
            set_bit(mask, fact);
        }
    };
    add(problem_.preconditions[action]);
    add(problem_.negative_preconditions[action]);
    for (const EffectId effect : problem_.effects[action]) {
        add(problem_.effect_conditions[effect]);
        add(problem_.effect_negative_conditions[effect]);
    }
    for (const CostPartId part : problem_.cost_parts[action]) {
        for (const AlternativeId alternative : problem_.cost_alternatives[part]) {
            add(problem_.cost_conditions[alternative]);
            add(problem_.cost_negative_conditions[alternative]);
        }
    }
}

// Tarjan's algorithm (1972) without recursion: components are closed after all that they lead to.
void RelevantFacts::find_components() {
    struct Visit {
        TaskId task;
        std::uint32_t method;   // of the task's, the one looked at
        std::uint32_t subtask;  // of it, the next one to look at
    };
    std::vector<std::uint32_t> number(problem_.task_count(), kUnvisited);
    std::vector<std::uint32_t> lowest(problem_.task_count(), kUnvisited);
    std::vector<Visit> visits;
    std::vector<TaskId> stack;
    std::uint32_t next_number = 0;
    const auto enter = [&](TaskId task) {
        number[task] = lowest[task] = next_number++;
        stack.push_back(task);
        visits.push_back({task, 0, 0});
    };
    for (const TaskId root : problem_.compounds()) {
        if (number[root] == kUnvisited) {
            enter(root);
        }
        while (!visits.empty()) {
            limits_.stop_if_reached();
            Visit& visit = visits.back();
            const TaskId task = visit.task;
            const auto methods = problem_.methods_of(task);
            if (visit.method < methods.size()) {
                const auto subtasks = problem_.method_subtasks[methods[visit.method]];
                if (visit.subtask == subtasks.size()) {
                    ++visit.method;
                    visit.subtask = 0;
                    continue;
                }
                const TaskId subtask = subtasks[visit.subtask++];
                if (problem_.is_primitive(subtask) || component_[subtask] != kUnvisited) {
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
                close_component(std::span(first, stack.end()));
                stack.erase(first, stack.end());
            }
        }
    }
}

void RelevantFacts::close_component(std::span<const TaskId> members) {
    const std::uint32_t component = component_count_++;
    masks_of_components_.resize(component_count_ * words_, 0);
    for (const TaskId task : members) {
        component_[task] = component;
    }
    const auto mask = std::span(masks_of_components_).last(words_);
    for (const TaskId task : members) {
        for (const MethodId method : problem_.methods_of(task)) {
            limits_.stop_if_reached();
            for (const TaskId subtask : problem_.method_subtasks[method]) {
                unite(mask, of(subtask));
            }
        }
    }
}

std::span<const std::uint64_t> RelevantFacts::of(TaskNetworks& networks, NetworkId network) {
    return masks_[find(networks, network)];
}

RelevantFacts::MaskId RelevantFacts::find(TaskNetworks& networks, NetworkId network) {
    if (known(network) != kUnknown) {
        return known(network);
    }
    std::ranges::fill(mask_, 0);
    if (networks.are_totally_ordered()) {
        return find_in_chain(networks, network);
    }
    tasks_.clear();
    networks.tasks(network, tasks_);
    for (const TaskId task : tasks_) {
        unite(mask_, of(task));
    }
    return known(network) = masks_.intern(mask_);
}

// What matters to a list is what matters to its first task and to the rest.
RelevantFacts::MaskId RelevantFacts::find_in_chain(TaskNetworks& networks, NetworkId network) {
    chain_.clear();
    for (; known(network) == kUnknown && !networks.is_empty(network); network = networks.progress(network, 0)) {
        limits_.stop_if_reached();
        chain_.push_back(network);
    }
    if (known(network) == kUnknown) {
        known(network) = masks_.intern(mask_);  // nothing matters to the empty list
    }
    std::ranges::copy(masks_[known(network)], mask_.begin());
    for (std::size_t at = chain_.size(); at-- > 0;) {
        limits_.stop_if_reached();
        first_.clear();
        networks.unconstrained(chain_[at], first_);
        unite(mask_, of(first_.front().task));
        known(chain_[at]) = masks_.intern(mask_);
    }
    return masks_.intern(mask_);
}

RelevantFacts::MaskId& RelevantFacts::known(NetworkId network) {
    while (mask_of_network_.size() <= network) {
        mask_of_network_.push_back(kUnknown);
    }
    return mask_of_network_[network];
}

}  // namespace relax
