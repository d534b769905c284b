#ifndef RELAX_VALUATIONS_SCENARIO_TOTALS_HPP
#define RELAX_VALUATIONS_SCENARIO_TOTALS_HPP

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/cost.hpp"
#include "relax/valuations/law_objective.hpp"
#include "relax/valuations/mixture.hpp"
#include "relax/valuations/scenario_options.hpp"
#include "relax/valuations/scenario_tangent.hpp"
#include "relax/valuations/sum_vectors.hpp"
#include "relax/valuations/valuation.hpp"

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
class ScenarioTotals final : public Valuation {
public:
    // `prices`: by scenario, in steps; `asks_scenarios`: whether a heuristic is asked at them, too, and not only at the
    // prices of the tangents, of which there is at least one. All prices must live longer.
    ScenarioTotals(std::vector<const PricedProblem*> prices, std::vector<double> probabilities,
                   std::vector<ScenarioTangent> tangents, bool asks_scenarios,
                   std::shared_ptr<const LawObjective> objective, std::vector<ScenarioBudget> budgets,
                   const ScenarioOptions& options);

    std::span<const PricedProblem* const> prices() const override { return prices_; }
    std::size_t asked() const override { return asks_scenarios_ ? prices_.size() : tangents_.size(); }
    ValueId start() override { return sums_.start(); }
    ValueId extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) override {
        return sums_.extend(value, action, due_parts);
    }
    Worth worth(ValueId value) override;
    Worth bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) override;
    Cost tie_break(ValueId value, const CostToCome& to_come) override;
    bool is_as_good(ValueId one, ValueId other, const CostToCome& to_come) override;

private:
    double spent(ValueId value, const ScenarioTangent& tangent) const;
    std::span<const Cost> least_totals(const CostToCome& to_come) const {
        return to_come.least.subspan(tangents_.size());
    }

    SumVectors sums_;
    std::vector<double> probabilities_;
    std::vector<ScenarioTangent> tangents_;
    std::vector<const PricedProblem*> prices_;  // those of the tangents, then by scenario
    bool asks_scenarios_;
    std::shared_ptr<const LawObjective> objective_;
    std::vector<ScenarioBudget> budgets_;
    ScenarioOptions options_;
    double last_;  // the cost beyond which all are one to the objective, and to the budgets
    Mixture mixture_;
};

}  // namespace relax

#endif
