#include "relax/valuations/mean_cvar.hpp"

#include <algorithm>
#include <cstddef>

#include "relax/valuations/quantile.hpp"

namespace relax {

namespace {

struct Excess {
    double probability;  // of more than a cost
    double mean;         // excess over it
};

Excess excess_of_sum(const Law& law, FlooredLaw& other, double cost) {
    other.rewind();
    Excess sum{0.0, 0.0};
    for (std::size_t i = 0; i < law.size(); ++i) {
        sum.mean += law.probability[i] * other.excess_over(cost - law.at[i]);
        sum.probability += law.probability[i] * other.above_cost(cost - law.at[i]);
    }
    return sum;
}

}  // namespace

double MeanCvarOfLaw::steps(const Law& law) const {
    const auto enough = std::ranges::partition_point(law.above, [this](double above) { return above > tail_; });
    const auto at = static_cast<std::size_t>(enough - law.above.begin());
    return (1.0 - weight_) * law.mean() + weight_ * (law.at[at] + law.excess[at] / tail_);
}

// What is minimised over t is convex, and the least whole t that is exceeded with a probability of at most 1 - level
// and the one before have slopes of both signs: it is nowhere below both tangents.
double MeanCvarOfLaw::bound_of_sum(const Law& law, FlooredLaw& other) const {
    const double right = least_steps_exceeded_by(law, other, tail_);
    const Excess after = excess_of_sum(law, other, right);
    const Excess before = excess_of_sum(law, other, right - 1);
    const double rise = 1.0 - after.probability / tail_;
    const double fall = before.probability / tail_ - 1.0;
    const double value_after = right + after.mean / tail_;
    const double value_before = right - 1 + before.mean / tail_;
    const double back =
        rise + fall > 0 ? std::clamp((value_after - value_before + fall) / (rise + fall), 0.0, 1.0) : 0.0;
    const double cvar = value_after - rise * back;
    return rounded_down((1.0 - weight_) * (law.mean() + other.mean()) + weight_ * cvar);
}

// A quantile that is taken one outcome too far, or too near, for a probability that is off, costs that much of it.
double MeanCvarOfLaw::rounded_down(double steps) const {
    return step_ * (steps - kLawRounding * steps * std::max(1.0, 0x1p-4 / tail_));
}

}  // namespace relax
