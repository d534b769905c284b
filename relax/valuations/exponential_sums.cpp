#include "relax/valuations/exponential_sums.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "relax/base/infinite.hpp"
#include "relax/valuations/cover.hpp"

namespace relax {

namespace {

constexpr double kLogError = 0x1p-48;  // of a logarithm, by the size of what it is made of
constexpr double kLostBesideOne = 36;  // e^-36 is lost beside 1

double log_growth(double exponent) {  // ln(e^x - 1) for a positive x
    return exponent > kLostBesideOne ? exponent : std::log(std::expm1(exponent));
}

}  // namespace

ExponentialSums::ExponentialSums(std::vector<const PricedProblem*> prices, std::vector<int> exponents, double linear,
                                 std::vector<ExponentialTerm> terms, std::vector<PriceMix> mixes, FiniteOptions options)
    : sums_(prices),
      prices_(std::move(prices)),
      disutility_(linear, std::move(terms)),
      options_(options),
      point_(prices_.size()),
      raised_(prices_.size()) {
    assert(prices_.size() == disutility_.size() && exponents.size() == prices_.size());
    for (const int exponent : exponents) {
        units_.push_back(std::ldexp(1.0, -exponent));
    }
    if (options_.bound_mixes && disutility_.is_convex()) {
        mixes_ = std::move(mixes);
    }
    for (const PriceMix& mix : mixes_) {
        prices_.push_back(mix.prices);
        std::vector<double>& weights = mix_weights_.emplace_back(mix.weights);
        for (std::size_t price = 0; price < weights.size(); ++price) {
            weights[price] /= units_[price];
        }
    }
}

double ExponentialSums::cost(std::size_t price, Cost units) const { return static_cast<double>(units) * units_[price]; }

Worth ExponentialSums::worth(ValueId value) {
    const std::span<const Cost> sums = sums_[value];
    for (std::size_t price = 0; price < sums.size(); ++price) {
        point_[price] = cost(price, sums[price]);
    }
    return order_of(disutility_.certainty_equivalent(point_));
}

Worth ExponentialSums::bound(ValueId value, const CostToCome& to_come, std::uint32_t /*stage*/) {
    if (to_come.is_dead_end()) {
        return kNoWorth;
    }
    const std::span<const Cost> sums = sums_[value];
    for (std::size_t price = 0; price < sums.size(); ++price) {
        point_[price] = cost(price, add_bounds(sums[price], to_come.least[price]));
    }
    double known = disutility_.certainty_equivalent(point_);
    for (std::size_t mix = 0; mix < mixes_.size(); ++mix) {
        const double rest = mixes_[mix].rest(to_come.least, to_come.least[sums.size() + mix]);
        if (rest > 0) {
            raised_ = point_;
            disutility_.raise(raised_, mix_weights_[mix], rest);
            known = disutility_.certainty_equivalent(raised_, known);
        }
    }
    return order_of(known);
}

bool ExponentialSums::are_as_good(std::span<const ValueId> ways, ValueId other, const CostToCome& to_come) {
    if (std::ranges::any_of(ways, [&](ValueId one) { return sums_.is_nowhere_more(one, other); })) {
        return true;
    }
    if (!options_.compare_boxes) {
        return false;
    }
    if (disutility_.has_linear() && disutility_.size() == 2 && disutility_.is_convex()) {
        if (options_.compare_envelopes) {
            return is_below_lines(ways, other, to_come);
        }
        return std::ranges::any_of(ways, [&](ValueId one) { return is_below_lines({&one, 1}, other, to_come); });
    }
    return std::ranges::any_of(ways, [&](ValueId one) { return is_in_box(one, other, to_come); });
}

// Whether everywhere one of the lines mu + e^(l + A kappa) t is at most as high as that of the other way. Where it is
// higher in one of the two it is so on one side of the point where they cross.
bool ExponentialSums::is_below_lines(std::span<const ValueId> ways, ValueId other, const CostToCome& to_come) {
    const auto [slope, log_weight] = disutility_.terms().front();
    const std::span<const Cost> sums = sums_[other];
    const double log = log_weight + slope * cost(1, sums[1]);
    const double size = 1 + std::abs(log_weight) + std::abs(log) + std::abs(disutility_.log_linear());
    Cover cover;
    for (const ValueId one : ways) {
        const Cost mean = sums_[one][0] - sums[0];
        const Cost risk = sums_[one][1] - sums[1];
        if ((mean > 0) == (risk > 0) || mean == 0 || risk == 0) {
            continue;  // as good nowhere, or the caller has seen that it is everywhere
        }
        const double exponent = slope * cost(1, risk);
        const double log_mean = disutility_.log_linear() + std::log(std::abs(cost(0, mean)));
        if (mean > 0) {
            const double log_risk = std::log(-std::expm1(exponent));
            cover.add_from(log_mean - log - log_risk + kLogError * (size + std::abs(log_mean) + std::abs(log_risk)));
        } else {
            const double log_risk = log_growth(exponent);
            cover.add_up_to(log_mean - log - log_risk - kLogError * (size + std::abs(log_mean) + std::abs(log_risk)));
        }
    }
    const double low = slope * cost(1, to_come.least[1]);
    return cover.covers(low, std::max(low, most_log(sums, to_come.least, 0) - log));
}

// Whether one way is as good as the other at the worst corner of the box of the t_j. Each term is divided by the same
// number, and by more where it is negative.
bool ExponentialSums::is_in_box(ValueId one, ValueId other, const CostToCome& to_come) {
    const std::span<const ExponentialTerm> terms = disutility_.terms();
    const std::span<const Cost> left = sums_[one];
    const std::span<const Cost> right = sums_[other];
    const std::size_t first = disutility_.has_linear() ? 1 : 0;
    double largest = disutility_.log_linear();
    for (std::size_t j = 0; j < terms.size(); ++j) {
        point_[first + j] = cost(first + j, add_bounds(right[first + j], to_come.least[first + j]));
        largest = std::max(largest, terms[j].log_weight + terms[j].slope * point_[first + j]);
    }
    double sum = 0;
    const auto add = [&](double term, double size) { sum += term + kLogError * (2 + size) * std::abs(term); };
    if (first == 1) {
        add(std::exp(disutility_.log_linear() - largest) * cost(0, left[0] - right[0]), std::abs(largest));
    }
    for (std::size_t j = 0; j < terms.size(); ++j) {
        const auto [slope, log_weight] = terms[j];
        const Cost more = left[first + j] - right[first + j];
        if (more == 0 || (slope < 0 && more < 0)) {
            continue;  // negative at most, and 0 where t is
        }
        const double exponent = slope * cost(first + j, more);
        double log = log_weight + slope * point_[first + j];
        if (slope > 0 && more > 0) {
            log = std::max(log, most_log(right, to_come.least, j));
        }
        const double growth = std::expm1(exponent);
        const double size = std::abs(log_weight) + std::abs(slope * point_[first + j]) + std::abs(log) +
                            std::abs(largest) + std::abs(exponent);
        add(std::exp(log - largest) * (slope > 0 ? growth : -growth), size);
    }
    return sum <= 0;
}

// The logarithm of how large a rising exponential can be at the end of a way that leads to a plan that is wanted: the
// disutility of the cutoff less the least of all other terms. Rounded up.
double ExponentialSums::most_log(std::span<const Cost> sums, std::span<const Cost> least, std::size_t term) const {
    if (!options_.use_cutoff || std::isnan(cutoff_)) {
        return kInfinite;
    }
    const std::span<const ExponentialTerm> terms = disutility_.terms();
    const std::size_t first = disutility_.has_linear() ? 1 : 0;
    const double reference = terms[term].log_weight + terms[term].slope * cutoff_;
    double sum = 1;  // all of it divided by the term at the cutoff
    double error = kLogError * (1 + std::abs(terms[term].log_weight) + std::abs(reference));
    const auto add = [&](double part, double size) {
        sum += part;
        error += kLogError * (2 + size + std::abs(reference)) * std::abs(part);
    };
    if (first == 1) {
        const double mass = std::exp(disutility_.log_linear() - reference);
        add(mass * cutoff_, std::abs(disutility_.log_linear()));
        add(-mass * cost(0, add_bounds(sums[0], least[0])), std::abs(disutility_.log_linear()));
    }
    for (std::size_t j = 0; j < terms.size(); ++j) {
        if (j == term) {
            continue;
        }
        const auto [slope, log_weight] = terms[j];
        const double sign = slope > 0 ? 1 : -1;
        const double here = log_weight + slope * cutoff_;
        const double there = log_weight + slope * cost(first + j, add_bounds(sums[first + j], least[first + j]));
        add(sign * std::exp(here - reference), std::abs(log_weight) + std::abs(here));
        add(-sign * std::exp(there - reference), std::abs(log_weight) + std::abs(there));
    }
    const double most = sum + error;
    return most < kInfinite ? reference + std::log(std::max(most, error)) + error : kInfinite;
}

}  // namespace relax
