#ifndef RELAX_VALUATIONS_LAW_TABLE_HPP
#define RELAX_VALUATIONS_LAW_TABLE_HPP

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "relax/base/id_table.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/valuations/law.hpp"

namespace relax {

using LawId = Id<struct LawTag>;

inline constexpr std::size_t kAnyNumber = std::numeric_limits<std::size_t>::max();

// What laws of a table may leave out.
struct LawDetail {
    // Outcomes beyond it are one: at their mean, so that whatever is linear from there on has the same expectation ...
    double last = std::numeric_limits<double>::infinity();
    // ... or one step further, where nothing that lies beyond is worse than anything else that does.
    bool is_flat_beyond = false;
    // Laws with more outcomes are made smaller: costs that are near each other become the least of them, so that the
    // law is below the true one in the usual stochastic order ...
    std::size_t most_outcomes = kAnyNumber;
    // ... or their mean, so that it is in the increasing convex order.
    bool keeps_means = false;
    // The more sums have been worked out, the fewer outcomes: that number is halved from time to time, down to this.
    std::size_t fewest_outcomes = kAnyNumber;
};

// Laws of costs, equal ones once, and the laws of sums of independent costs, each remembered. Probabilities are not
// rounded on purpose: laws that would be equal may differ in the last bits, where their summands came in another order.
class LawTable {
public:
    static constexpr LawId kFree{0};  // the cost is certain, and nothing

    explicit LawTable(const LawDetail& detail);
    LawTable(const LawTable&) = delete;

    std::size_t size() const { return laws_.size(); }
    const LawDetail& detail() const { return detail_; }
    // Whether a law has been made smaller.
    bool has_put_together() const { return has_put_together_; }
    const Law& operator[](LawId id) const { return laws_[id]; }

    // Outcomes ascending and whole, probabilities positive, summing to 1.
    LawId add(std::span<const double> at, std::span<const double> probabilities);
    // The law of the sum of two independent costs. Throws Stopped.
    LawId sum(LawId one, LawId other, Limits& limits);

private:
    struct Sum {
        LawId one;
        LawId other;
        LawId sum;
    };

    void convolve(const Law& one, const Law& other, Limits& limits);
    void add_densely(const Law& one, const Law& other, double least, Limits& limits);
    void add_sparsely(const Law& one, const Law& other, Limits& limits);
    void put_together();
    LawId intern();
    std::uint64_t hash_of(std::span<const double> at, std::span<const double> probabilities) const;

    LawDetail detail_;
    SegmentedArray<Law> laws_;
    IdTable<LawId> table_;
    SegmentedArray<Sum> sums_;
    IdTable<> sum_table_;
    RunArena<double> values_;

    // The law being made.
    std::vector<double> at_;
    std::vector<double> probability_;
    std::vector<double> dense_;
    std::vector<std::pair<double, double>> pairs_;
    std::vector<std::pair<double, double>> merged_;
    double work_ = 0.0;  // pairs of outcomes that were added up since the number of outcomes was halved
    double beyond_probability_ = 0.0;
    double beyond_cost_ = 0.0;  // its part of the mean
    bool is_whole_ = true;
    bool has_put_together_ = false;
};

}  // namespace relax

#endif
