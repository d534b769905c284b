#ifndef RELAX_VALUATIONS_EXPECTED_DISUTILITY_HPP
#define RELAX_VALUATIONS_EXPECTED_DISUTILITY_HPP

#include <vector>

#include "relax/valuations/law_objective.hpp"

namespace relax {

// A function of the total cost x in steps that does not fall:
// base + slope x + the sum over kinks of (jump if x > at) + rise max(x - at, 0).
struct PiecewiseDisutility {
    struct Kink {
        double at;
        double jump;
        double rise;
    };
    double base;
    double slope;
    std::vector<Kink> kinks;  // ascending
};

// Its expectation: that a deadline is missed (a jump from 0 to 1), an overrun (a slope from 0 to 1), minus the expected
// utility of a piecewise linear one.
class ExpectedDisutility final : public LawObjective {
public:
    explicit ExpectedDisutility(PiecewiseDisutility disutility);

    LawDetail detail() const override;
    bool is_concave() const override { return is_concave_; }
    double value(const Law& law) const override;
    double bound(const Law& law, double more) const override;
    double bound_of_sum(const Law& law, FlooredLaw& other) const override;
    // Compares the expectations of one + y and other + y for all y from `least` on: piecewise linear in y. Not where
    // there are jumps: with one jump and nothing else the stochastic order up to there says as much.
    bool is_as_good(const Law& one, const Law& other, double least) const override;

private:
    double expectation(const Law& law, double more, double& scale) const;

    PiecewiseDisutility disutility_;
    bool is_flat_beyond_;
    bool is_concave_;
    bool has_jumps_;
};

}  // namespace relax

#endif
