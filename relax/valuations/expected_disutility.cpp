#include "relax/valuations/expected_disutility.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "relax/valuations/law_orders.hpp"

namespace relax {

namespace {

// Of the sum of all slopes, which are doubles: less is none.
constexpr double kNoSlope = 0x1p-40;

}  // namespace

ExpectedDisutility::ExpectedDisutility(PiecewiseDisutility disutility) : disutility_(std::move(disutility)) {
    assert(!disutility_.kinks.empty());
    double slope = disutility_.slope;
    double steepest = slope;
    is_concave_ = true;
    has_jumps_ = false;
    for (const auto& kink : disutility_.kinks) {
        slope += kink.rise;
        steepest = std::max(steepest, slope);
        has_jumps_ = has_jumps_ || kink.jump > 0;
        is_concave_ = is_concave_ && kink.jump == 0 && kink.rise >= 0;
    }
    is_flat_beyond_ = std::abs(slope) <= kNoSlope * steepest;
}

LawDetail ExpectedDisutility::detail() const {
    return {.last = disutility_.kinks.back().at, .is_flat_beyond = is_flat_beyond_};
}

double ExpectedDisutility::value(const Law& law) const {
    double scale = 0.0;
    return expectation(law, 0.0, scale);
}

double ExpectedDisutility::bound(const Law& law, double more) const {
    double scale = 0.0;
    const double value = expectation(law, more, scale);
    return value - kLawRounding * scale;
}

// `scale`: what the sizes of all terms sum up to, to which rounding is relative.
double ExpectedDisutility::expectation(const Law& law, double more, double& scale) const {
    const double linear = disutility_.slope * (law.mean() + more);
    double value = disutility_.base + linear;
    scale = std::abs(disutility_.base) + linear;
    for (const auto& kink : disutility_.kinks) {
        const double at = kink.at - more;
        const std::size_t from = law.outcomes_up_to(at);
        const double jump = kink.jump > 0 ? kink.jump * law.above_of(from) : 0.0;
        const double rise = kink.rise * law.excess_over(at, from);
        value += jump + rise;
        scale += jump + std::abs(rise);
    }
    return value;
}

double ExpectedDisutility::bound_of_sum(const Law& law, FlooredLaw& other) const {
    const double linear = disutility_.slope * (law.mean() + other.mean());
    double value = disutility_.base + linear;
    double scale = std::abs(disutility_.base) + linear;
    for (const auto& kink : disutility_.kinks) {
        double above = 0.0;
        double excess = 0.0;
        other.rewind();
        for (std::size_t i = 0; i < law.size(); ++i) {
            const double at = kink.at - law.at[i];
            if (kink.jump > 0) {
                above += law.probability[i] * other.above_cost(at);
            }
            if (kink.rise != 0) {
                excess += law.probability[i] * other.excess_over(at);
            }
        }
        value += kink.jump * above + kink.rise * excess;
        scale += kink.jump * above + std::abs(kink.rise) * excess;
    }
    return value - kLawRounding * scale;
}

bool ExpectedDisutility::is_as_good(const Law& one, const Law& other, double least) const {
    if (has_jumps_) {
        return false;
    }
    const auto is_at_most = [&](double more) {
        double scale = 0.0;
        double other_scale = 0.0;
        const double value = expectation(one, more, scale);
        const double other_value = expectation(other, more, other_scale);
        return value <= other_value + kExcessTolerance * std::min(scale, other_scale);
    };
    // Beyond the last kink less the least outcome the difference stays as it is there.
    const double most = std::max(least, disutility_.kinks.back().at - std::min(one.least(), other.least()));
    if (!is_at_most(least) || !is_at_most(most)) {
        return false;
    }
    for (const auto& kink : disutility_.kinks) {
        for (const Law* law : {&one, &other}) {
            for (const double at : law->at) {
                const double more = kink.at - at;
                if (more > least && more < most && !is_at_most(more)) {
                    return false;
                }
            }
        }
    }
    return true;
}

}  // namespace relax
