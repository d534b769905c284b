#include "relax/policies/disutility_terms.hpp"

#include <algorithm>
#include <cmath>

#include "relax/base/infinite.hpp"

namespace relax {

namespace {

constexpr double kLargeExponent = 30;  // 1 is a rounding error of its exponential, but for a factor of some hundreds

// ln of `(e^(a x) - 1 + shift) / a`, for a > 0 and a large a x.
double log_of_large(double slope, double exponent, double shift) {
    return exponent - std::log(slope) + std::log1p((shift - 1) * std::exp(-exponent));
}

}  // namespace

double log_sum(double one, double other) {
    const double larger = std::max(one, other);
    return larger == -kInfinite ? larger : larger + std::log1p(std::exp(std::min(one, other) - larger));
}

DisutilityTerm DisutilityTerm::of(double slope, double log_weight, double step, bool is_only_sought) {
    if (is_only_sought) {
        return {slope, log_weight, 1 / slope};
    }
    const double base = std::min(step, 1.0);
    return {slope, log_weight, slope > 0 ? std::min(base, 1 / slope) : base};
}

double DisutilityTerm::log_at(double cost) const {
    const double exponent = slope * cost;
    if (is_only_sought()) {
        return exponent - std::log(-slope);
    }
    if (exponent > kLargeExponent) {
        return log_of_large(slope, exponent, slope * base);
    }
    return std::log(base + (slope == 0 ? cost : std::expm1(exponent) / slope));
}

double DisutilityTerm::log_constant(double spent) const {
    const double kept = 1 - base * slope;
    if (kept <= 0 || is_only_sought()) {
        return -kInfinite;
    }
    const double exponent = slope * spent;
    if (exponent > kLargeExponent) {
        return std::log(kept) + log_of_large(slope, exponent, 0);
    }
    return std::log(kept * (slope == 0 ? spent : std::expm1(exponent) / slope));
}

double worth_of(std::span<const DisutilityTerm> terms, double cost) {
    double sum = -kInfinite;
    for (const DisutilityTerm& term : terms) {
        sum = log_sum(sum, term.log_weight + term.log_at(cost));
    }
    return terms.front().is_only_sought() ? -sum : sum;
}

double certain_cost(std::span<const DisutilityTerm> terms, double worth) {
    double low = 0;
    double high = 1;
    while (worth_of(terms, high) < worth) {
        if (high == kInfinite) {
            return high;
        }
        low = high;
        high *= 2;
    }
    while (true) {
        const double middle = low + (high - low) / 2;
        if (middle <= low || middle >= high) {
            return high;
        }
        (worth_of(terms, middle) < worth ? low : high) = middle;
    }
}

}  // namespace relax
