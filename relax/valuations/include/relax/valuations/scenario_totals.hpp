#ifndef RELAX_VALUATIONS_SCENARIO_TOTALS_HPP
#define RELAX_VALUATIONS_SCENARIO_TOTALS_HPP

#include <memory>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/valuations/law_objective.hpp"
#include "relax/valuations/scenario_options.hpp"
#include "relax/valuations/scenario_tangent.hpp"
#include "relax/valuations/scenario_valuation.hpp"
#include "relax/valuations/sum_vectors.hpp"

namespace relax {

// Plans in scenarios that decide all: in each of them costs are certain, and a way has a total. A plan is worth what
// the objective says of the law that has each scenario's total with its probability.
//
// A bound of all completions is the objective at the ideal point: what a way has cost in each scenario and what its
// network costs at least in it, as if each scenario could choose for itself. Where the objective is convex in the
// totals, its tangents are bounds, too (ScenarioTangent): they see that one completion is for all scenarios.
//
// Ways are compared scenario by scenario: a way that has cost no more in any of them than another one is as good, as
// the same completion adds the same. Where the objective does not tell costs beyond a bound from each other, those
// scenarios do not count in which the other way cannot but get beyond it.
//
// Jensen's inequality says nothing here: a completion's mean over all scenarios is not its mean given one of them.
class ScenarioTotals final : public ScenarioValuation {
public:
    // `prices`: by scenario, in steps. See ScenarioValuation.
    ScenarioTotals(const std::vector<const PricedProblem*>& prices, std::vector<double> probabilities,
                   std::vector<ScenarioTangent> tangents, bool asks_scenarios,
                   std::shared_ptr<const LawObjective> objective, std::vector<ScenarioBudget> budgets,
                   const ScenarioOptions& options);

    ValueId start() override { return sums_.start(); }
    ValueId extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) override {
        return sums_.extend(value, action, due_parts);
    }
    Worth worth(ValueId value) override;
    Worth bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) override;
    bool is_as_good(ValueId one, ValueId other, const CostToCome& to_come) override;

private:
    double spent(ValueId value, const ScenarioTangent& tangent) const override;

    SumVectors sums_;
    std::vector<double> probabilities_;
    double last_;  // the cost beyond which all are one to the objective, and to the budgets
};

}  // namespace relax

#endif
