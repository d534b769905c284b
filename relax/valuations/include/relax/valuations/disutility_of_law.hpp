#ifndef RELAX_VALUATIONS_DISUTILITY_OF_LAW_HPP
#define RELAX_VALUATIONS_DISUTILITY_OF_LAW_HPP

#include <span>
#include <utility>
#include <vector>

#include "relax/valuations/disutility.hpp"
#include "relax/valuations/law_objective.hpp"

namespace relax {

// The certain cost that is as bad as a law by a disutility of a linear term and exponentials, in units of cost: steps
// times `step`. Where costs are independent it follows from sums of prices (ExponentialSums); laws are for where plans
// have to keep budgets over scenarios, too.
//
// Exponential means of independent costs add up, and no convolution is needed.
class DisutilityOfLaw final : public LawObjective {
public:
    DisutilityOfLaw(double linear, std::vector<ExponentialTerm> terms, double step)
        : disutility_(linear, std::move(terms)), step_(step) {}

    bool is_concave() const override { return disutility_.is_convex(); }
    double value(const Law& law) const override;
    double bound(const Law& law, double more) const override;
    double bound_of_sum(const Law& law, FlooredLaw& other) const override;

private:
    void start() const;
    void add(const FlooredLaw& law, bool rounds_down) const;

    mutable Disutility disutility_;  // has room for its own computations
    double step_;
    mutable std::vector<double> point_;  // what it says of the law, see Disutility
};

}  // namespace relax

#endif
