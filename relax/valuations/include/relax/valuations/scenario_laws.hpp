#ifndef RELAX_VALUATIONS_SCENARIO_LAWS_HPP
#define RELAX_VALUATIONS_SCENARIO_LAWS_HPP

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/valuations/cost_laws.hpp"
#include "relax/valuations/law_objective.hpp"
#include "relax/valuations/law_options.hpp"
#include "relax/valuations/law_table.hpp"
#include "relax/valuations/scenario_options.hpp"
#include "relax/valuations/scenario_tangent.hpp"
#include "relax/valuations/scenario_valuation.hpp"

namespace relax {

// What actions cost in a scenario: a law each, and the least costs, in steps.
struct ScenarioCosts {
    double probability;
    const PricedProblem* least;
    CostLaws laws;
};

// Plans whose costs are independent given a scenario, which is common to all of them: a way has a law in each scenario,
// and a plan is worth what the objective says of their mixture.
//
// A bound of all completions: given a scenario, what is to come is independent of what the way has cost, is at least
// the least cost to come there, and is stochastically at least the sum of the laws of the network's tasks in that
// scenario's graph of laws, as if each scenario could choose for itself. A mixture of laws that are all stochastically
// smaller is stochastically smaller. Where the objective is concave, its tangents are bounds, too (ScenarioTangent).
//
// A way is as good as another one if it is in each scenario: sums with what is to come, and mixtures, keep both the
// usual stochastic order and the increasing convex one; and where a rule compares expectations of one function after
// each completion, they add up over the scenarios.
//
// Jensen's inequality with what is to come in the mean over all scenarios is no bound: what is to come depends on the
// scenario, as does what the way has cost.
class ScenarioLaws final : public ScenarioValuation {
public:
    // See ScenarioValuation; the first tangent has no price 0 that is not certain.
    ScenarioLaws(const std::vector<ScenarioCosts>& scenarios, std::vector<ScenarioTangent> tangents,
                 bool asks_scenarios, std::shared_ptr<const LawObjective> objective,
                 std::vector<ScenarioBudget> budgets, const ScenarioOptions& options, const LawOptions& law_options);

    void begin(const TaskNetworks& networks, Limits& limits) override;
    ValueId start() override;
    ValueId extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) override;
    Worth worth(ValueId value) override;
    std::uint32_t stages() const override { return options().ideal_bound && law_options_.graph_bound ? 2 : 1; }
    Worth bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) override;
    bool is_as_good(ValueId one, ValueId other, const CostToCome& to_come) override;

private:
    struct Scenario {
        Scenario(const ScenarioCosts& costs, const LawDetail& detail, const LawOptions& options);

        double probability;
        LawsSoFar so_far;
        LawsToCome to_come;
        LawTable sums;  // of a way and what is to come, for bounds
    };

    std::span<const LawId> laws(ValueId value) const { return {rows_[value], scenarios_.size()}; }
    ValueId intern();
    double least(const CostToCome& to_come, std::size_t scenario) const {
        return options().ideal_bound ? static_cast<double>(least_by_scenario(to_come)[scenario]) : 0.0;
    }
    double spent(ValueId value, const ScenarioTangent& tangent) const override;
    const Law& shifted(ValueId value, const CostToCome& to_come);
    const Law& with_graphs(ValueId value, const CostToCome& to_come);

    std::deque<Scenario> scenarios_;
    LawOptions law_options_;
    std::vector<double> at_;
    std::vector<double> probability_;

    std::vector<LawId> row_;  // that is looked for
    RunArena<LawId> ids_;
    SegmentedArray<const LawId*> rows_;
    IdTable<ValueId> table_;
    Limits no_limits_;
    Limits* limits_ = &no_limits_;
};

}  // namespace relax

#endif
