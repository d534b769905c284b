#ifndef RELAX_PROGRESSION_POLICY_SPACE_HPP
#define RELAX_PROGRESSION_POLICY_SPACE_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "relax/base/id_table.hpp"
#include "relax/base/limits.hpp"
#include "relax/progression/policy_progression.hpp"
#include "relax/progression/step_amounts.hpp"

namespace relax {

// Every node that decisions can lead to, breadth first: for those who want the whole Markov decision process.
class PolicySpace {
public:
    struct Outcome {
        std::uint32_t node;
        std::optional<ActionId> action;  // as in PolicyOutcome
        std::vector<CostPartId> due_parts;
    };
    struct Decision {
        SearchStep step;
        std::vector<Outcome> outcomes;
    };

    // The progression must live longer. Nodes that were reached when there are `most_nodes` have no decisions; then,
    // and where a limit was reached, the space is not complete.
    PolicySpace(PolicyProgression& progression, std::size_t most_nodes, Limits& limits);

    std::size_t node_count() const { return nodes_.size(); }
    std::size_t expanded_count() const { return decisions_.size(); }
    std::optional<StopReason> stop() const { return stop_; }
    StateId state(std::uint32_t node) const { return nodes_[node].first; }
    NetworkId network(std::uint32_t node) const { return nodes_[node].second; }
    // Of a node that was expanded.
    const std::vector<Decision>& decisions(std::uint32_t node) const { return decisions_[node]; }
    // Of a complete space: the largest total cost of a run, whatever is decided and whatever comes, from the largest
    // costs of actions and of parts; none where a loop costs something, so that there is no largest one.
    std::optional<double> most_cost(const StepAmounts& largest_costs) const;

private:
    std::uint32_t number_of(StateId state, NetworkId network);

    std::vector<std::pair<StateId, NetworkId>> nodes_;
    std::vector<std::vector<Decision>> decisions_;
    IdTable<> table_;
    std::optional<StopReason> stop_;
};

}  // namespace relax

#endif
