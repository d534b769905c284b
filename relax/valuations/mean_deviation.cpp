#include "relax/valuations/mean_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "relax/base/infinite.hpp"
#include "relax/valuations/cover.hpp"

namespace relax {

namespace {

constexpr double kDown = 1 - 0x1p-48;
constexpr double kError = 0x1p-48;

}  // namespace

MeanDeviation::MeanDeviation(double weight, std::array<const PricedProblem*, 2> prices, std::array<int, 2> exponents,
                             std::vector<PriceMix> mixes, FiniteOptions options)
    : weight_(weight),
      sums_({prices[0], prices[1]}),
      prices_({prices[0], prices[1]}),
      units_({std::ldexp(1.0, -exponents[0]), std::ldexp(1.0, -exponents[1])}),
      options_(options) {
    if (options_.bound_mixes) {
        mixes_ = std::move(mixes);
    }
    for (const PriceMix& mix : mixes_) {
        prices_.push_back(mix.prices);
    }
}

Worth MeanDeviation::worth(ValueId value) {
    const std::span<const Cost> sums = sums_[value];
    const double mean = static_cast<double>(sums[0]) * units_[0];
    const double variance = static_cast<double>(sums[1]) * units_[1];
    return order_of((mean + weight_ * std::sqrt(variance)) * kDown);
}

// The value rises in both sums, and is concave: with a mix of theirs bounded, too, it is least where one sum alone is
// raised.
Worth MeanDeviation::bound(ValueId value, const CostToCome& to_come, std::uint32_t /*stage*/) {
    if (to_come.is_dead_end()) {
        return kNoWorth;
    }
    const std::span<const Cost> sums = sums_[value];
    const auto mean = static_cast<double>(add_bounds(sums[0], to_come.least[0]));
    const auto variance = static_cast<double>(add_bounds(sums[1], to_come.least[1]));
    const auto worth_of = [&](double means, double variances) {
        return means * units_[0] + weight_ * std::sqrt(variances * units_[1]);
    };
    double least = worth_of(mean, variance);
    for (std::size_t at = 0; at < mixes_.size(); ++at) {
        const PriceMix& mix = mixes_[at];
        const double rest = mix.rest(to_come.least, to_come.least[2 + at]);
        if (rest > 0) {
            const double riskier = mix.weights[1] > 0 ? worth_of(mean, variance + rest / mix.weights[1]) : kInfinite;
            const double dearer = mix.weights[0] > 0 ? worth_of(mean + rest / mix.weights[0], variance) : kInfinite;
            least = std::max(least, std::min(riskier, dearer));
        }
    }
    return order_of(least * kDown);
}

bool MeanDeviation::are_as_good(std::span<const ValueId> ways, ValueId other, const CostToCome& to_come) {
    if (std::ranges::any_of(ways, [&](ValueId one) { return sums_.is_nowhere_more(one, other); })) {
        return true;
    }
    if (!options_.compare_boxes) {
        return false;
    }
    if (options_.compare_envelopes) {
        return is_covered(ways, other, to_come);
    }
    return std::ranges::any_of(ways, [&](ValueId one) { return is_covered({&one, 1}, other, to_come); });
}

// Whether for every deviation that the other way may end with, one of these is as good.
bool MeanDeviation::is_covered(std::span<const ValueId> ways, ValueId other, const CostToCome& to_come) {
    const std::span<const Cost> sums = sums_[other];
    Cover cover;
    for (const ValueId one : ways) {
        const double mean = static_cast<double>(sums_[one][0] - sums[0]) * units_[0] / weight_;
        const double variance = static_cast<double>(sums_[one][1] - sums[1]) * units_[1];
        if (mean < 0 && variance > 0) {
            const double error = kError * (variance / -mean - mean);
            cover.add_from((variance / -mean + mean) / 2 + error);
        } else if (mean > 0 && variance < 0 && -variance * kDown >= mean * mean) {
            cover.add_up_to((-variance / mean + mean) / 2 * kDown);
        }
    }
    const double low = std::sqrt(static_cast<double>(add_bounds(sums[1], to_come.least[1])) * units_[1]) * kDown;
    double high = kInfinite;
    if (options_.use_cutoff && !std::isnan(cutoff_)) {
        const double mean = static_cast<double>(add_bounds(sums[0], to_come.least[0])) * units_[0];
        high = (cutoff_ - mean + kError * cutoff_) / weight_;
    }
    return cover.covers(low, std::max(low, high));
}

}  // namespace relax
