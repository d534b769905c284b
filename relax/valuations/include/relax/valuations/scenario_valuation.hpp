#ifndef RELAX_VALUATIONS_SCENARIO_VALUATION_HPP
#define RELAX_VALUATIONS_SCENARIO_VALUATION_HPP

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/cost.hpp"
#include "relax/valuations/law.hpp"
#include "relax/valuations/law_objective.hpp"
#include "relax/valuations/mixture.hpp"
#include "relax/valuations/scenario_options.hpp"
#include "relax/valuations/scenario_tangent.hpp"
#include "relax/valuations/valuation.hpp"

namespace relax {

// Plans by what an objective says of the mixture over all scenarios, of those that keep budgets: what is common to
// costs that are certain in each scenario, and to those that have a law there.
class ScenarioValuation : public Valuation {
public:
    std::span<const PricedProblem* const> prices() const override { return prices_; }
    std::size_t asked() const override { return asks_scenarios_ ? prices_.size() : tangents_.size(); }
    Cost tie_break(ValueId value, const CostToCome& to_come) override;

protected:
    // `asks_scenarios`: whether a heuristic is asked at the prices of the scenarios, too, and not only at those of the
    // tangents, of which there is at least one. All prices must live longer.
    ScenarioValuation(std::vector<ScenarioTangent> tangents, std::vector<const PricedProblem*> by_scenario,
                      bool asks_scenarios, std::shared_ptr<const LawObjective> objective,
                      std::vector<ScenarioBudget> budgets, const ScenarioOptions& options);

    // The sum of q_k x_k of a tangent for what a way has cost.
    virtual double spent(ValueId value, const ScenarioTangent& tangent) const = 0;

    // By the prices of the scenarios.
    std::span<const Cost> least_by_scenario(const CostToCome& to_come) const {
        return to_come.least.subspan(tangents_.size());
    }
    // Of a plan whose cost has this law.
    Worth worth_of(const Law& law) const;
    // Of all completions of a way, of which no law is stochastically below this one.
    Worth bound_of(const Law& law, ValueId value, const CostToCome& to_come) const;

    const LawObjective& objective() const { return *objective_; }
    std::span<const ScenarioBudget> budgets() const { return budgets_; }
    const ScenarioOptions& options() const { return options_; }

    Mixture mixture_;

private:
    std::vector<ScenarioTangent> tangents_;
    std::vector<const PricedProblem*> prices_;  // those of the tangents, then by scenario
    bool asks_scenarios_;
    std::shared_ptr<const LawObjective> objective_;
    std::vector<ScenarioBudget> budgets_;
    ScenarioOptions options_;
};

}  // namespace relax

#endif
