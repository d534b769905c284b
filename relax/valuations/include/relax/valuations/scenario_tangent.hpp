#ifndef RELAX_VALUATIONS_SCENARIO_TANGENT_HPP
#define RELAX_VALUATIONS_SCENARIO_TANGENT_HPP

#include <cmath>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/cost.hpp"
#include "relax/valuations/law.hpp"

namespace relax {

// A bound of an objective that is convex in what a plan costs in each scenario, linear in that: constant + the sum of
// q_k x_k, in the objective's unit, with x_k the cost in steps, or its mean where it is uncertain given the scenario.
// (By Jensen's inequality given each scenario, where the actions of a plan are independent.) For the conditional value
// at risk it weighs the scenarios that were the worst of some plan.
struct ScenarioTangent {
    const PricedProblem* priced;  // the sums of q_k p_k ...
    double units;                 // ... of which so many are one in the objective's unit
    double constant;
    std::vector<double> weights;  // q, by scenario; none is negative

    // Of all completions of a way of which `spent` is the sum of q_k x_k.
    double bound(double spent, Cost least) const {
        const double total = spent + static_cast<double>(least) / units;
        return constant + total - kLawRounding * (total + std::abs(constant));
    }
    // By which ways come where bounds are equal.
    Cost tie_break(double spent, Cost least) const {
        const double total = spent * units + static_cast<double>(least);
        return total < static_cast<double>(kMostCost) ? static_cast<Cost>(total) : kMostCost;
    }
};

}  // namespace relax

#endif
