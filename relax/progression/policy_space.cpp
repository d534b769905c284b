#include "relax/progression/policy_space.hpp"

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
