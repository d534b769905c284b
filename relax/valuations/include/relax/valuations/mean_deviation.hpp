#ifndef RELAX_VALUATIONS_MEAN_DEVIATION_HPP
#define RELAX_VALUATIONS_MEAN_DEVIATION_HPP

#include <array>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/cost.hpp"
#include "relax/base/worth.hpp"
#include "relax/valuations/finite_options.hpp"
#include "relax/valuations/price_mix.hpp"
#include "relax/valuations/sum_vectors.hpp"
#include "relax/valuations/valuation.hpp"

namespace relax {

// Plans by the mean of their cost and so many standard deviations: means and variances are sums. A plan is worth
// `order_of` its value in the domain's own unit. Prices were rounded down to units, so nothing exceeds what is true.
//
// Let M and V be the sums of a way, d > 0 by how much the mean of another one is less, divided by the weight, and
// D > 0 by how much its variance is more. Completed by a variance v the other is as good if
// sqrt(V + D + v) - sqrt(V + v) <= d. The difference of two roots, divided by that of their squares, is the reciprocal
// of their sum: so that is sqrt(V + v) >= (D/d - d) / 2. Likewise a way with the larger mean and the smaller variance
// is as good if sqrt(V + v) <= (D/d + d) / 2, unless D < d^2: then it never is.
class MeanDeviation final : public Valuation {
public:
    // `prices`: of means and of variances; a unit is 2^-exponent. `mixes`: of these. All must live longer.
    MeanDeviation(double weight, std::array<const PricedProblem*, 2> prices, std::array<int, 2> exponents,
                  std::vector<PriceMix> mixes, FiniteOptions options);

    std::span<const PricedProblem* const> prices() const override { return prices_; }
    ValueId start() override { return sums_.start(); }
    ValueId extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) override {
        return sums_.extend(value, action, due_parts);
    }
    Worth worth(ValueId value) override;
    // Rounded down by 2^-48 of itself, far more than a root, two products and two sums lose.
    Worth bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) override;
    Cost tie_break(ValueId /*value*/, const CostToCome& to_come) override { return to_come.least.front(); }
    bool is_as_good(ValueId one, ValueId other, const CostToCome& to_come) override {
        return are_as_good({&one, 1}, other, to_come);
    }
    bool are_as_good(std::span<const ValueId> ways, ValueId other, const CostToCome& to_come) override;
    void set_cutoff(Worth cutoff) override { cutoff_ = value_of(cutoff); }

private:
    bool is_covered(std::span<const ValueId> ways, ValueId other, const CostToCome& to_come);

    double weight_;
    SumVectors sums_;
    std::vector<const PricedProblem*> prices_;  // and those of mixes
    std::array<double, 2> units_;
    FiniteOptions options_;
    std::vector<PriceMix> mixes_;
    double cutoff_ = value_of(kNoWorth);  // no number: all plans are wanted
};

}  // namespace relax

#endif
