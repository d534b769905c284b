#include "relax/valuations/law_table.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

namespace relax {

namespace {

// An array of all costs between the least and the largest sum is filled where it has few places more than there are
// pairs of outcomes, or is small anyway.
constexpr double kPlacesPerPair = 8;
constexpr double kFewPlaces = 256;
constexpr std::size_t kPairsUntilCheck = 1 << 14;
constexpr double kPairsUntilFewer = 1 << 26;  // some tenths of a second

std::uint64_t hash_pair(LawId one, LawId other) { return mix((std::uint64_t{one} << 32) | other); }

}  // namespace

LawTable::LawTable(const LawDetail& detail) : detail_(detail) {
    constexpr std::array<double, 1> nothing{0.0};
    constexpr std::array<double, 1> certain{1.0};
    add(nothing, certain);
}

LawId LawTable::add(std::span<const double> at, std::span<const double> probabilities) {
    assert(!at.empty() && at.size() == probabilities.size() && at.front() >= 0);
    at_.clear();
    probability_.clear();
    beyond_probability_ = beyond_cost_ = 0.0;
    is_whole_ = true;
    for (std::size_t i = 0; i < at.size(); ++i) {
        is_whole_ = is_whole_ && (at[i] == std::floor(at[i]) || at[i] > detail_.last);
        if (at[i] > detail_.last) {
            beyond_probability_ += probabilities[i];
            beyond_cost_ += probabilities[i] * at[i];
        } else {
            at_.push_back(at[i]);
            probability_.push_back(probabilities[i]);
        }
    }
    return intern();
}

LawId LawTable::sum(LawId one, LawId other, Limits& limits) {
    if (one == kFree || other == kFree) {
        return one == kFree ? other : one;
    }
    const std::uint64_t hash = hash_pair(one, other);
    const auto known =
        sum_table_.find(hash, [&](std::uint32_t id) { return sums_[id].one == one && sums_[id].other == other; });
    if (known) {
        return sums_[*known].sum;
    }
    convolve(laws_[one], laws_[other], limits);
    const LawId sum = intern();
    const auto id = static_cast<std::uint32_t>(sums_.size());
    sums_.push_back({one, other, sum});
    sum_table_.add(hash, id);
    return sum;
}

// Into the law being made.
void LawTable::convolve(const Law& one, const Law& other, Limits& limits) {
    at_.clear();
    probability_.clear();
    beyond_probability_ = beyond_cost_ = 0.0;
    const double least = one.least() + other.least();
    const double places = std::min(one.most() + other.most(), detail_.last) - least + 1;
    const auto pairs = static_cast<double>(one.size()) * static_cast<double>(other.size());
    if ((work_ += pairs) > kPairsUntilFewer && detail_.most_outcomes / 2 >= detail_.fewest_outcomes) {
        detail_.most_outcomes /= 2;
        work_ = 0.0;
    }
    is_whole_ = one.is_whole && other.is_whole;
    if (is_whole_ && places <= std::max(kFewPlaces, kPlacesPerPair * pairs)) {
        add_densely(one, other, least, limits);
    } else {
        add_sparsely(one, other, limits);
    }
}

void LawTable::add_densely(const Law& one, const Law& other, double least, Limits& limits) {
    const double places = std::min(one.most() + other.most(), detail_.last) - least + 1;
    dense_.assign(places > 0 ? static_cast<std::size_t>(places) : 0, 0.0);
    std::size_t pairs = 0;
    for (std::size_t j = 0; j < other.size(); ++j) {
        const double shift = other.at[j];
        const double weight = other.probability[j];
        const std::size_t end = one.outcomes_up_to(detail_.last - shift);
        for (std::size_t i = 0; i < end; ++i) {
            dense_[static_cast<std::size_t>(one.at[i] + shift - least)] += one.probability[i] * weight;
        }
        for (std::size_t i = end; i < one.size(); ++i) {
            beyond_probability_ += one.probability[i] * weight;
            beyond_cost_ += one.probability[i] * weight * (one.at[i] + shift);
        }
        if ((pairs += one.size()) >= kPairsUntilCheck) {
            limits.stop_if_reached();
            pairs = 0;
        }
    }
    for (std::size_t place = 0; place < dense_.size(); ++place) {
        if (dense_[place] > 0) {
            at_.push_back(least + static_cast<double>(place));
            probability_.push_back(dense_[place]);
        }
    }
}

void LawTable::add_sparsely(const Law& one, const Law& other, Limits& limits) {
    pairs_.clear();
    for (std::size_t j = 0; j < other.size(); ++j) {
        for (std::size_t i = 0; i < one.size(); ++i) {
            pairs_.emplace_back(one.at[i] + other.at[j], one.probability[i] * other.probability[j]);
        }
        limits.stop_if_reached();
    }
    // Runs that are in order are merged, two at a time.
    merged_.resize(pairs_.size());
    for (std::size_t run = one.size(); run < pairs_.size(); run *= 2) {
        for (std::size_t begin = 0; begin < pairs_.size(); begin += 2 * run) {
            const auto at = [this](std::size_t place) {
                return pairs_.begin() + static_cast<std::ptrdiff_t>(std::min(place, pairs_.size()));
            };
            std::merge(at(begin), at(begin + run), at(begin + run), at(begin + 2 * run),
                       merged_.begin() + static_cast<std::ptrdiff_t>(begin));
        }
        pairs_.swap(merged_);
    }
    for (const auto& [cost, probability] : pairs_) {
        if (cost > detail_.last) {
            beyond_probability_ += probability;
            beyond_cost_ += probability * cost;
        } else if (!at_.empty() && at_.back() == cost) {
            probability_.back() += probability;
        } else if (probability > 0) {
            at_.push_back(cost);
            probability_.push_back(probability);
        }
    }
}

// Of the law being made: the outcomes in each cell of a coarser grid become one.
void LawTable::put_together() {
    if (at_.size() <= detail_.most_outcomes) {
        return;
    }
    has_put_together_ = true;
    is_whole_ = is_whole_ && !detail_.keeps_means;
    double width = std::max(2.0, (at_.back() - at_.front()) / static_cast<double>(detail_.most_outcomes));
    for (; at_.size() > detail_.most_outcomes; width *= 2) {
        std::size_t kept = 0;
        double cell = std::floor(at_[0] / width);
        for (std::size_t i = 1; i < at_.size(); ++i) {
            const double next = std::floor(at_[i] / width);
            if (next == cell) {
                const double sum = probability_[kept] + probability_[i];
                if (detail_.keeps_means) {
                    at_[kept] += (at_[i] - at_[kept]) * (probability_[i] / sum);
                }
                probability_[kept] = sum;
            } else {
                cell = next;
                ++kept;
                at_[kept] = at_[i];
                probability_[kept] = probability_[i];
            }
        }
        at_.resize(kept + 1);
        probability_.resize(kept + 1);
    }
}

// Take up the law that was made.
LawId LawTable::intern() {
    put_together();
    if (beyond_probability_ > 0) {
        at_.push_back(detail_.is_flat_beyond ? detail_.last + 1 : beyond_cost_ / beyond_probability_);
        probability_.push_back(beyond_probability_);
    }
    const std::uint64_t hash = hash_of(at_, probability_);
    const auto known = table_.find(hash, [this](LawId id) {
        return std::ranges::equal(laws_[id].at, at_) && std::ranges::equal(laws_[id].probability, probability_);
    });
    if (known) {
        return *known;
    }
    const std::size_t size = at_.size();
    const std::span<double> at = values_.allocate(size);
    const std::span<double> probability = values_.allocate(size);
    const std::span<double> above = values_.allocate(size);
    const std::span<double> excess = values_.allocate(size);
    std::ranges::copy(at_, at.begin());
    std::ranges::copy(probability_, probability.begin());
    above[size - 1] = excess[size - 1] = 0;
    for (std::size_t i = size - 1; i-- > 0;) {
        above[i] = above[i + 1] + probability[i + 1];
        excess[i] = excess[i + 1] + above[i] * (at[i + 1] - at[i]);
    }
    const auto id = static_cast<LawId>(laws_.size());
    laws_.push_back({at, probability, above, excess, is_whole_});
    table_.add(hash, id);
    return id;
}

std::uint64_t LawTable::hash_of(std::span<const double> at, std::span<const double> probabilities) const {
    std::uint64_t hash = at.size();
    for (std::size_t i = 0; i < at.size(); ++i) {
        hash =
            combine(combine(hash, std::bit_cast<std::uint64_t>(at[i])), std::bit_cast<std::uint64_t>(probabilities[i]));
    }
    return hash;
}

}  // namespace relax
