#ifndef RELAX_VALUATIONS_EXPONENTIAL_SUMS_HPP
#define RELAX_VALUATIONS_EXPONENTIAL_SUMS_HPP

#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/cost.hpp"
#include "relax/base/worth.hpp"
#include "relax/valuations/disutility.hpp"
#include "relax/valuations/finite_options.hpp"
#include "relax/valuations/price_mix.hpp"
#include "relax/valuations/sum_vectors.hpp"
#include "relax/valuations/valuation.hpp"

namespace relax {

// Plans by the certainty equivalent of a disutility that is a linear term and exponentials (Disutility): of every way
// one sum for each term, of means for the linear one, of exponential means for the others. A plan is worth `order_of`
// its certainty equivalent in the domain's own unit.
//
// Sums are of prices that were rounded down to units, so that nothing here exceeds what is true.
//
// Ways are compared by what is added to them, (m, k_1, ..) in sums. For each completion, one way is at most as bad as
// another if
//
//     linear (mu - mu') + sum of s_j (e^(l_j + A_j K_j) - e^(l_j + A_j K'_j)) t_j <= 0,    t_j = e^(A_j k_j):
//
// this is linear in each t_j, so it holds of all completions if it does where each t_j is at that end of its range at
// which its term is the largest. One end is that of the least k_j; at the other t_j is 0 (negative slopes), or as large
// as it can be in a plan that is wanted. For a linear term and one rising exponential, ways are lines in t: one is
// superfluous if nowhere in the range it is below all others, the lower envelope of which may be of several.
class ExponentialSums final : public Valuation {
public:
    // `prices`: of the linear term, if its weight is above 0, and of each exponential; a unit is 2^-exponent.
    // `mixes`: of these prices; used where no slope is negative. All prices must live longer.
    ExponentialSums(std::vector<const PricedProblem*> prices, std::vector<int> exponents, double linear,
                    std::vector<ExponentialTerm> terms, std::vector<PriceMix> mixes, FiniteOptions options);

    std::span<const PricedProblem* const> prices() const override { return prices_; }
    ValueId start() override { return sums_.start(); }
    ValueId extend(ValueId value, ActionId action, std::span<const CostPartId> due_parts) override {
        return sums_.extend(value, action, due_parts);
    }
    Worth worth(ValueId value) override;
    // Rounded down: see Disutility.
    Worth bound(ValueId value, const CostToCome& to_come, std::uint32_t stage) override;
    Cost tie_break(ValueId /*value*/, const CostToCome& to_come) override { return to_come.least.front(); }
    bool is_as_good(ValueId one, ValueId other, const CostToCome& to_come) override {
        return are_as_good({&one, 1}, other, to_come);
    }
    bool are_as_good(std::span<const ValueId> ways, ValueId other, const CostToCome& to_come) override;
    void set_cutoff(Worth cutoff) override { cutoff_ = value_of(cutoff); }

private:
    double cost(std::size_t price, Cost units) const;
    bool is_in_box(ValueId one, ValueId other, const CostToCome& to_come);
    bool is_below_lines(std::span<const ValueId> ways, ValueId other, const CostToCome& to_come);
    double most_log(std::span<const Cost> sums, std::span<const Cost> least, std::size_t term) const;

    SumVectors sums_;
    std::vector<const PricedProblem*> prices_;  // and those of mixes
    std::vector<double> units_;
    Disutility disutility_;
    FiniteOptions options_;
    std::vector<PriceMix> mixes_;
    std::vector<std::vector<double>> mix_weights_;  // per unit of cost
    double cutoff_ = value_of(kNoWorth);            // no number: all plans are wanted
    std::vector<double> point_;
    std::vector<double> raised_;
};

}  // namespace relax

#endif
