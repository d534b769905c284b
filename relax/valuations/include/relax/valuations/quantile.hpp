#ifndef RELAX_VALUATIONS_QUANTILE_HPP
#define RELAX_VALUATIONS_QUANTILE_HPP

#include "relax/valuations/law_objective.hpp"

namespace relax {

// Levels are reached to within this.
inline constexpr double kLevelTolerance = 1e-12;

// The probability that the sum of two independent costs is more than a cost.
double above_of_sum(const Law& law, FlooredLaw& other, double cost);

// The least whole number of steps that is exceeded by the sum with at most this probability.
double least_steps_exceeded_by(const Law& law, FlooredLaw& other, double probability);

// The least budget that is kept with a probability (the value at risk), in units of cost: steps times `step`.
class QuantileOfLaw final : public LawObjective {
public:
    QuantileOfLaw(double level, double step) : step_(step), tail_(1.0 - level + kLevelTolerance) {}

    bool is_concave() const override { return false; }
    double value(const Law& law) const override { return step_ * steps(law, tail_); }
    double bound(const Law& law, double more) const override;
    double bound_of_sum(const Law& law, FlooredLaw& other) const override;

private:
    static double steps(const Law& law, double tail);

    double step_;
    double tail_;
};

}  // namespace relax

#endif
