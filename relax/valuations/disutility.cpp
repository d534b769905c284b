#include "relax/valuations/disutility.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "relax/base/infinite.hpp"

namespace relax {

namespace {

constexpr double kTermError = 0x1p-50;   // of a term, by the size of its exponents
constexpr double kPointError = 0x1p-51;  // of each kappa
constexpr double kConverged = 0x1p-50;
constexpr double kSlack = 0x1p-49;     // of the certainty equivalent
constexpr double kSafeExponent = 600;  // far from the range of floating point
constexpr int kMostSteps = 200;

}  // namespace

Disutility::Disutility(double linear, std::vector<ExponentialTerm> terms)
    : linear_(linear),
      log_linear_(linear > 0 ? std::log(linear) : -kInfinite),
      terms_(std::move(terms)),
      logs_(terms_.size()),
      masses_(terms_.size()),
      levels_(terms_.size()),
      order_(terms_.size()) {
    assert(linear >= 0 && size() > 0);
    for (const ExponentialTerm& term : terms_) {
        assert(term.slope != 0);
        is_convex_ = is_convex_ && term.slope > 0;
    }
}

// The certainty equivalent c is the root of the sum over the terms of their disutility at c less that at the point:
//
//     linear (c - kappa_0) + sum of sign(A_j) e^(l_j + A_j kappa_j) (e^(A_j (c - kappa_j)) - 1),
//
// each of which rises in c and is 0 at its own kappa: so c lies between the least and the largest of these. All are
// divided by the largest e^(l_j + A_j kappa_j), and e^x - 1 loses nothing where A_j is small.
//
// Rounding: a term is off by a part of itself, some units of 2^-53 times the size of its exponents. Terms that are
// positive are rounded up by more than that, negative ones down: the sum is too large, its root too small, however
// badly the root is conditioned. What is left, rounding of the kappas (2^-53 of each) and of the last step of Newton's
// method, is at most some units of 2^-50 of the largest kappa.
//
// Newton's method begins at the root of the tangents, each at its own kappa. It bisects where a step leaves the
// bracket, or is not at most half the last one: far up an exponential, steps are of equal size.
double Disutility::certainty_equivalent(std::span<const double> point, double known) {
    assert(point.size() == size());
    auto [low, high] = std::ranges::minmax(point);
    if (high <= known) {
        return known;
    }
    const double* const kappa = point.data() + (has_linear() ? 1 : 0);
    double largest = log_linear_;
    for (std::size_t j = 0; j < terms_.size(); ++j) {
        logs_[j] = terms_[j].log_weight + terms_[j].slope * kappa[j];
        largest = std::max(largest, logs_[j]);
    }
    linear_mass_ = std::exp(log_linear_ - largest);
    double weight = linear_mass_;
    double weighted = has_linear() ? linear_mass_ * point.front() : 0;
    for (std::size_t j = 0; j < terms_.size(); ++j) {
        logs_[j] -= largest;
        masses_[j] = std::exp(logs_[j]);
        weight += masses_[j] * std::abs(terms_[j].slope);
        weighted += masses_[j] * std::abs(terms_[j].slope) * kappa[j];
    }
    point_error_ = kPointError * weighted;
    if (known > low && excess(known * (1 + kSlack), point).excess >= 0) {
        return known;
    }
    double cost = weight > 0 && weighted < kInfinite ? std::clamp(weighted / weight, low, high) : high;
    double last = high - low;
    for (int step = 0; step < kMostSteps; ++step) {
        const auto [value, slope] = excess(cost, point);
        const double change = value / slope;
        if (std::abs(change) <= kConverged * cost) {
            low = cost - change;
            break;
        }
        (value > 0 ? high : low) = cost;
        if (high - low <= kConverged * high) {
            break;
        }
        const double next = cost - change;
        if (next > low && next < high && std::abs(change) <= last / 2) {
            last = std::abs(change);
            cost = next;
        } else {  // also if it is no number
            last = (high - low) / 2;
            cost = low + last;
        }
    }
    return std::max(low * (1 - kSlack), known);
}

// By how much a certain cost is worse than the point, rounded up, and how fast that rises; divided by what is largest.
Disutility::Value Disutility::excess(double cost, std::span<const double> point) const {
    const double* const kappa = point.data() + (has_linear() ? 1 : 0);
    double shift = 0;  // where a term at this cost is out of range, all are made smaller
    for (std::size_t j = 0; j < terms_.size(); ++j) {
        shift = std::max(shift, logs_[j] + terms_[j].slope * (cost - kappa[j]) - kSafeExponent);
    }
    const double factor = shift > 0 ? std::exp(-shift) : 1;
    double sum = point_error_ * factor;
    double slope = linear_mass_ * factor;
    if (has_linear()) {
        const double change = linear_mass_ * factor * (cost - point.front());
        sum += change + 4 * kTermError * std::abs(change);
    }
    for (std::size_t j = 0; j < terms_.size(); ++j) {
        const auto [rate, log_weight] = terms_[j];
        const double exponent = rate * (cost - kappa[j]);
        const double mass = masses_[j] * factor;
        double change;  // of e^(log + rate * cost), of either sign
        double there;   // itself
        if (exponent < 1) {
            const double growth = std::expm1(exponent);
            change = mass * growth;
            there = mass * (1 + growth);
        } else {  // the mass may have been too small for a number
            there = std::exp(logs_[j] - shift + exponent);
            change = there - mass;
        }
        const double error =
            kTermError * (2 + std::abs(log_weight) + std::abs(rate * kappa[j]) + std::abs(exponent)) * std::abs(change);
        sum += (rate > 0 ? change : -change) + error;
        slope += std::abs(rate) * there;
    }
    return {sum, slope};
}

// By Lagrange: each kappa that is raised ends where the marginal disutility per weight, l_j + ln A_j - ln w_j + A_j
// kappa_j as a logarithm, is at one common level, and those not raised are above it. The linear term is always at its
// level: it takes what is left. Below it the level rises with the rest in linear pieces.
void Disutility::raise(std::span<double> point, std::span<const double> weights, double rest) {
    assert(is_convex_ && point.size() == size() && weights.size() == size());
    const std::size_t first = has_linear() ? 1 : 0;
    const double top = has_linear() && weights[0] > 0 ? log_linear_ - std::log(weights[0]) : kInfinite;
    for (std::size_t j = 0; j < terms_.size(); ++j) {
        const auto [slope, log_weight] = terms_[j];
        const double weight = weights[first + j];
        levels_[j] = weight > 0 ? log_weight + slope * point[first + j] + std::log(slope / weight) : kInfinite;
    }
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::ranges::sort(order_, {}, [this](std::size_t j) { return levels_[j]; });
    double rate = 0;  // at which the rest is used up as the level rises
    double level = -kInfinite;
    double left = rest;
    for (std::size_t at = 0; level < top; ++at) {
        const double next = at < order_.size() ? std::min(levels_[order_[at]], top) : top;
        const double used = rate > 0 ? rate * (next - level) : 0;
        if (rate > 0 && used >= left) {
            level += left / rate;
            break;
        }
        left -= used;
        level = next;
        if (level < top) {
            const std::size_t j = order_[at];
            rate += weights[first + j] / terms_[j].slope;
        }
    }
    // Where slopes are small, levels are known to far less than what their differences stand for.
    double used = 0;
    for (std::size_t j = 0; j < terms_.size(); ++j) {
        levels_[j] = std::max(0.0, (level - levels_[j]) / terms_[j].slope);
        used += weights[first + j] * levels_[j];
    }
    const double part = used > rest ? rest / used : 1;
    for (std::size_t j = 0; j < terms_.size(); ++j) {
        point[first + j] += part * levels_[j];
    }
    if (level == top) {
        point.front() += std::max(0.0, rest - used) / weights[0];
    }
}

}  // namespace relax
