#ifndef RELAX_VALUATIONS_LAW_HPP
#define RELAX_VALUATIONS_LAW_HPP

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <span>

namespace relax {

// By how much the sums of this header may be off, relative to themselves: all terms are positive, and each is a product
// of as many probabilities as a plan has actions, each good to 2^-53.
inline constexpr double kLawRounding = 0x1p-40;

// The law of a cost on a grid: ascending outcomes in steps of the grid, each with its probability. It stays where its
// table keeps it (LawTable). Outcomes are whole numbers below 2^53, so that their sums are exact, where none stand for
// several, at their mean. The last one may do so: it stands for all that lie beyond a bound where nobody tells them
// from each other.
struct Law {
    std::span<const double> at;
    std::span<const double> probability;
    std::span<const double> above;   // of each outcome: the probability of more
    std::span<const double> excess;  // likewise: the expected excess over it, E max(X - at, 0), in steps
    bool is_whole = true;            // all outcomes but the last one, if it lies beyond

    std::size_t size() const { return at.size(); }
    double least() const { return at.front(); }
    double most() const { return at.back(); }
    double total() const { return above.front() + probability.front(); }  // 1, but for rounding
    double mean() const { return at.front() * total() + excess.front(); }

    // P(X > cost), where `from` is the number of outcomes up to there.
    double above_of(std::size_t from) const { return from == 0 ? total() : above[from - 1]; }
    // E max(X - cost, 0), likewise.
    double excess_over(double cost, std::size_t from) const {
        return from == size() ? 0.0 : excess[from] + above_of(from) * (at[from] - cost);
    }
    std::size_t outcomes_up_to(double cost) const {
        return static_cast<std::size_t>(std::ranges::upper_bound(at, cost) - at.begin());
    }
    double above_cost(double cost) const { return above_of(outcomes_up_to(cost)); }
    double excess_over(double cost) const { return excess_over(cost, outcomes_up_to(cost)); }
};

// A law whose outcomes below a floor are raised to it. Asked at falling costs, it walks through the outcomes once.
class FlooredLaw {
public:
    FlooredLaw(const Law& law, double floor)
        : law_(&law), floor_(floor), below_(law.outcomes_up_to(floor)), from_(law.size()) {}

    double least() const { return std::max(law_->least(), floor_); }
    double most() const { return std::max(law_->most(), floor_); }
    double mean() const { return floor_ * law_->total() + law_->excess_over(floor_, below_); }

    // E f(max(X, floor)).
    template <typename Function>
    double expectation(Function f) const {
        double sum = 0.0;
        for_each([&](double probability, double cost) { sum += probability * f(cost); });
        return sum;
    }
    // f(probability, cost) for each outcome.
    template <typename Function>
    void for_each(Function f) const {
        f(law_->total() - law_->above_of(below_), floor_);
        for (std::size_t i = below_; i < law_->size(); ++i) {
            f(law_->probability[i], law_->at[i]);
        }
    }

    // Begin anew, at any cost.
    void rewind() { from_ = law_->size(); }
    // P(max(X, floor) > cost).
    double above_cost(double cost) {
        if (cost < floor_) {
            return law_->total();
        }
        walk_down_to(cost);
        return law_->above_of(from_);
    }
    // E max(max(X, floor) - cost, 0).
    double excess_over(double cost) {
        if (cost < floor_) {
            return law_->excess_over(floor_, below_) + law_->total() * (floor_ - cost);
        }
        walk_down_to(cost);
        return law_->excess_over(cost, from_);
    }

private:
    void walk_down_to(double cost) {
        while (from_ > 0 && law_->at[from_ - 1] > cost) {
            --from_;
        }
        assert(from_ == law_->outcomes_up_to(cost));
    }

    const Law* law_;
    double floor_;
    std::size_t below_;  // outcomes up to the floor
    std::size_t from_;
};

}  // namespace relax

#endif
