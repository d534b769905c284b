#include "relax/progression/policy_space.hpp"

#include <algorithm>
#include <span>

#include "relax/base/strong_components.hpp"

namespace relax {

namespace {

std::uint64_t hash_node(StateId state, NetworkId network) { return mix((std::uint64_t{state} << 32) | network); }

}  // namespace

PolicySpace::PolicySpace(PolicyProgression& progression, std::size_t most_nodes, Limits& limits) {
    stop_ = run_within_limits([&]() -> std::optional<StopReason> {
        number_of(progression.initial_state(), progression.initial_network());
        std::vector<PolicyDecision> found;
        while (decisions_.size() < nodes_.size() && nodes_.size() <= most_nodes) {
            limits.stop_if_reached();
            const auto [state, network] = nodes_[decisions_.size()];
            progression.decisions(state, network, found);
            std::vector<Decision> decisions;
            for (PolicyDecision& one : found) {
                Decision& decision = decisions.emplace_back();
                decision.step = one.step;
                for (PolicyOutcome& outcome : one.outcomes) {
                    decision.outcomes.push_back(
                        {number_of(outcome.state, outcome.network), outcome.action, std::move(outcome.due_parts)});
                }
            }
            decisions_.push_back(std::move(decisions));
        }
        return std::nullopt;
    });
}

std::optional<double> PolicySpace::most_cost(const StepAmounts& largest_costs) const {
    std::vector<std::uint32_t> first{0};
    std::vector<std::uint32_t> successors;
    std::vector<double> costs;
    for (const std::vector<Decision>& decisions : decisions_) {
        for (const Decision& decision : decisions) {
            for (const Outcome& outcome : decision.outcomes) {
                successors.push_back(outcome.node);
                costs.push_back(largest_costs.of(outcome));
            }
        }
        first.push_back(static_cast<std::uint32_t>(successors.size()));
    }
    std::vector<double> most(nodes_.size(), 0);  // once a node is visited
    std::vector<std::uint32_t> component_of(nodes_.size(), 0);
    std::uint32_t count = 0;
    bool is_bounded = true;
    StrongComponents().find(
        static_cast<std::uint32_t>(nodes_.size()),
        [&](std::uint32_t node) { return std::span(successors).subspan(first[node], first[node + 1] - first[node]); },
        [&](std::span<const std::uint32_t> component) {
            ++count;
            for (const std::uint32_t node : component) {
                component_of[node] = count;
            }
            double largest = 0;
            for (const std::uint32_t node : component) {
                for (std::uint32_t at = first[node]; at < first[node + 1]; ++at) {
                    const bool is_inside = component_of[successors[at]] == count;
                    is_bounded = is_bounded && !(is_inside && costs[at] > 0);
                    largest = std::max(largest, costs[at] + (is_inside ? 0 : most[successors[at]]));
                }
            }
            for (const std::uint32_t node : component) {
                most[node] = largest;
            }
        });
    return is_bounded ? std::optional(most.front()) : std::nullopt;
}

std::uint32_t PolicySpace::number_of(StateId state, NetworkId network) {
    const std::uint64_t hash = hash_node(state, network);
    const auto known = table_.find(hash, [&](std::uint32_t node) { return nodes_[node] == std::pair(state, network); });
    if (known) {
        return *known;
    }
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back(state, network);
    table_.add(hash, node);
    return node;
}

}  // namespace relax
