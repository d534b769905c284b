#ifndef RELAX_VALUATIONS_COST_LAWS_HPP
#define RELAX_VALUATIONS_COST_LAWS_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/networks/task_network.hpp"
#include "relax/valuations/graph_of_laws.hpp"
#include "relax/valuations/law_options.hpp"
#include "relax/valuations/law_table.hpp"

namespace relax {

// The laws of what actions cost on a grid: each law once, in whole steps.
struct CostLaws {
    struct Outcomes {
        std::vector<double> at;  // ascending
        std::vector<double> probabilities;
    };
    std::vector<Outcomes> laws;
    std::vector<std::uint32_t> actions;  // by ActionId, the number of a law: of what is always due
    std::vector<std::uint32_t> parts;    // by CostPartId

    // In a table, for these numbers.
    std::vector<LawId> in(LawTable& table, const std::vector<std::uint32_t>& numbers) const;
};

// The laws of what ways have cost so far.
class LawsSoFar {
public:
    LawsSoFar(const CostLaws& costs, const LawDetail& detail);

    const Law& operator[](LawId law) const { return table_[law]; }
    bool is_exact() const { return !table_.has_put_together(); }
    // After an action, where these parts of its cost were due. Throws Stopped.
    LawId extend(LawId law, ActionId action, std::span<const CostPartId> due_parts, Limits& limits);

private:
    LawTable table_;
    std::vector<LawId> actions_;  // by ActionId
    std::vector<LawId> parts_;    // by CostPartId
};

// Lower bounds of the laws of what is still to come, by the graph of laws: it is made once.
class LawsToCome {
public:
    // `least`: the same costs as prices, of each the least one in steps.
    LawsToCome(const PricedProblem& least, const CostLaws& costs, const LawDetail& detail, const LawOptions& options);

    // Both throw Stopped.
    void begin(const TaskNetworks& networks, Limits& limits);
    const Law& of(NetworkId network, Limits& limits);
    // As it is without any network. Throws Stopped.
    const Law& of_task(TaskId task, Limits& limits);

private:
    const PricedProblem& least_;
    bool has_parts_;
    LawTable table_;
    LawTable network_table_;
    std::vector<LawId> actions_;  // by ActionId: of what is always due
    std::vector<LawId> parts_;    // by CostPartId
    std::optional<GraphOfLaws> graph_;
    std::optional<NetworkLaws> networks_;
};

}  // namespace relax

#endif
