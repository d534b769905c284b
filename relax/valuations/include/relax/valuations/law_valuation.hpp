#ifndef RELAX_VALUATIONS_LAW_VALUATION_HPP
#define RELAX_VALUATIONS_LAW_VALUATION_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/valuations/cost_laws.hpp"
#include "relax/valuations/law_objective.hpp"
#include "relax/valuations/law_options.hpp"
#include "relax/valuations/law_table.hpp"
#include "relax/valuations/valuation.hpp"

namespace relax {

// Whether each independent cost of at least `least` steps makes the one worth at most as much as the other, as far as
// the rules tell that are allowed.
bool is_as_good(const LawObjective& objective, const LawOptions& options, const Law& one, const Law& other,
                double least);

// The law of what a way has cost, valued by an objective. Least costs and means are prices: in steps, and in units of
// which `units_per_step` are a step, both rounded down.
//
// A bound of all completions: what is to come, Y, is independent of what the way has cost, X. It costs at least h, by
// least costs; stochastically at least G, the sum of the laws of the network's tasks in the graph of laws; and m in the
// mean. So it is stochastically at least max(G, h), and no worth of X + Y is below that of X + max(G, h). Where the
// objective is concave, let c be such that E max(G, c) = m: then E max(Y - z, 0) >= E max(max(G, c) - z, 0) for all z
// (from c on since Y is at least G; below, since the right side is m - z), so that c is a floor, too. Without G it is m
// itself, by Jensen's inequality.
class LawValuation final : public Valuation {
public:
    LawValuation(const PricedProblem& least, const PricedProblem& means, double units_per_step, const CostLaws& costs,
                 std::shared_ptr<const LawObjective> objective, const LawOptions& options);

    std::span<const PricedProblem* const> prices() const override { return prices_; }
    // Means are for ties, too, where they bound nothing; a search asks at one price at least.
    std::size_t asked() const override { return std::max<std::size_t>(*mean_index_ + (needs_means() ? 1 : 0), 1); }
    void begin(const TaskNetworks& networks, Limits& limits) override;
    ValueId start() override { return ValueId{std::uint32_t{LawTable::kFree}}; }
    ValueId extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) override;
    Worth worth(ValueId value) override;
    std::uint32_t stages() const override { return options_.graph_bound ? 2 : 1; }
    Worth bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) override;
    Cost tie_break(ValueId value, const CostToCome& to_come) override;
    bool is_as_good(ValueId one, ValueId other, const CostToCome& to_come) override;

    // Of a way.
    const Law& law(ValueId value) const { return so_far_[LawId(std::uint32_t{value})]; }
    // Whether laws have all their outcomes.
    bool is_exact() const { return so_far_.is_exact(); }
    // Of a task in the graph of laws, whatever the networks are. Throws Stopped.
    const Law& law_of_task(TaskId task, Limits& limits) { return to_come_.of_task(task, limits); }

private:
    bool needs_means() const { return options_.mean_bound && objective_->is_concave(); }
    // Where it is not known, 0.
    double least_to_come(const CostToCome& to_come) const;
    double mean_to_come(const CostToCome& to_come) const;
    double floor(const CostToCome& to_come, const Law* graph) const;

    std::vector<const PricedProblem*> prices_;
    std::optional<std::size_t> least_index_;  // among the prices
    std::optional<std::size_t> mean_index_;
    double units_per_step_;
    std::shared_ptr<const LawObjective> objective_;
    LawOptions options_;
    LawsSoFar so_far_;
    LawsToCome to_come_;
    Limits no_limits_;
    Limits* limits_ = &no_limits_;
};

}  // namespace relax

#endif
