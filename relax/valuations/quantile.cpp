#include "relax/valuations/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace relax {

double above_of_sum(const Law& law, FlooredLaw& other, double cost) {
    other.rewind();
    double above = 0.0;
    for (std::size_t i = 0; i < law.size(); ++i) {
        above += law.probability[i] * other.above_cost(cost - law.at[i]);
    }
    return above;
}

double least_steps_exceeded_by(const Law& law, FlooredLaw& other, double probability) {
    double low = std::ceil(law.least() + other.least()) - 1;  // exceeded by more
    double high = std::ceil(law.most() + other.most());
    while (high - low > 1) {
        const double middle = std::floor((low + high) / 2);
        (above_of_sum(law, other, middle) > probability ? low : high) = middle;
    }
    return high;
}

double QuantileOfLaw::bound(const Law& law, double more) const {
    const double value = step_ * (steps(law, tail_ + kLawRounding) + more);
    return value - kLawRounding * value;
}

double QuantileOfLaw::bound_of_sum(const Law& law, FlooredLaw& other) const {
    const double value = step_ * least_steps_exceeded_by(law, other, tail_ + kLawRounding);
    return value - kLawRounding * value;
}

double QuantileOfLaw::steps(const Law& law, double tail) {
    const auto enough = std::ranges::partition_point(law.above, [tail](double above) { return above > tail; });
    return law.at[static_cast<std::size_t>(enough - law.above.begin())];
}

}  // namespace relax
