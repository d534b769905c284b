#include "relax/progression/relevant_facts.hpp"

#include <algorithm>

#include "relax/base/bits.hpp"

namespace relax {

RelevantFacts::RelevantFacts(const AnalysedProblem& problem, Limits& limits)
    : limits_(limits),
      reads_(problem.task_reads(limits)),
      masks_(words_for(problem.fact_count())),
      mask_(words_for(problem.fact_count())) {}

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
        unite(mask_, reads_[task]);
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
        unite(mask_, reads_[first_.front().task]);
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
