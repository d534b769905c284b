#include "relax/valuations/disutility_of_law.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace relax {

namespace {

constexpr double kMeanRounding = 4 * kLawRounding;

// ln E[e^(a X)] / a of a law in steps. Where a times the range is small, the logarithm is of a number near 1, of which
// only the difference from 1 is worked out; elsewhere an error of it is one of the exponential mean divided by a, which
// is at most the range. So it is good to some parts of kLawRounding of the range and of itself.
double exponential_mean(const FlooredLaw& law, double a) {
    const double least = law.least();
    const double most = law.most();
    if (std::abs(a) * (most - least) <= 1) {
        const double growth = law.expectation([&](double cost) { return std::expm1(a * (cost - least)); });
        return least + std::log1p(growth) / a;
    }
    const double from = a > 0 ? most : least;  // where the exponential is largest
    return from + std::log(law.expectation([&](double cost) { return std::exp(a * (cost - from)); })) / a;
}

}  // namespace

void DisutilityOfLaw::start() const { point_.assign(disutility_.size(), 0.0); }

void DisutilityOfLaw::add(const FlooredLaw& law, bool rounds_down) const {
    const auto in_units = [&](double steps) {
        const double error = rounds_down ? kMeanRounding * (law.most() - law.least() + steps) : 0.0;
        return step_ * std::max(steps - error, law.least());
    };
    std::size_t at = 0;
    if (disutility_.has_linear()) {
        point_[at++] += in_units(law.mean());
    }
    for (const ExponentialTerm& term : disutility_.terms()) {
        point_[at++] += in_units(exponential_mean(law, term.slope * step_));
    }
}

double DisutilityOfLaw::value(const Law& law) const {
    start();
    add(FlooredLaw(law, law.least()), false);
    return disutility_.certainty_equivalent(point_);
}

double DisutilityOfLaw::bound(const Law& law, double more) const {
    start();
    add(FlooredLaw(law, law.least()), true);
    for (double& number : point_) {
        number += step_ * more;
    }
    return disutility_.certainty_equivalent(point_) * (1 - kMeanRounding);
}

double DisutilityOfLaw::bound_of_sum(const Law& law, FlooredLaw& other) const {
    start();
    add(FlooredLaw(law, law.least()), true);
    add(other, true);
    return disutility_.certainty_equivalent(point_) * (1 - kMeanRounding);
}

}  // namespace relax
