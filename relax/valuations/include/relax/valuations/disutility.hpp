#ifndef RELAX_VALUATIONS_DISUTILITY_HPP
#define RELAX_VALUATIONS_DISUTILITY_HPP

#include <cmath>
#include <span>
#include <vector>

namespace relax {

// An exponential of a disutility: the sign of its slope times e^(log_weight + slope * cost). The slope is not 0.
struct ExponentialTerm {
    double slope;
    double log_weight;
};

// The disutility of a cost C, which rises in it: linear * C and exponentials, linear at least 0. Its expectation is
//
//     D(kappa) = linear * kappa_0 + sum of sign(A_j) e^(l_j + A_j kappa_j),
//
// where kappa_0 is the mean of C, and kappa_j = ln E[e^(A_j C)] / A_j its exponential means: a point has one number for
// each term, first that of the linear one if there is one. D rises in each. Terms are never multiplied out: a weight of
// e^(-10000) would be 0, the mean of e^(10000) infinite, and their product 1.
class Disutility {
public:
    Disutility(double linear, std::vector<ExponentialTerm> terms);

    bool has_linear() const { return linear_ > 0; }
    double log_linear() const { return log_linear_; }
    std::span<const ExponentialTerm> terms() const { return terms_; }
    std::size_t size() const { return terms_.size() + (has_linear() ? 1 : 0); }
    bool is_convex() const { return is_convex_; }  // no slope is negative

    // A lower bound of the certainty equivalent, the certain cost that is as bad as the point (numbers at least 0); if
    // it is no more than a number that is known, that number.
    double certainty_equivalent(std::span<const double> point, double known = 0);

    // Raise a point to the least bad one of all that are nowhere less and have at least the sum of weights * kappa that
    // it has and `rest` more: only where D is convex. Weights are at least 0, one of them is positive.
    void raise(std::span<double> point, std::span<const double> weights, double rest);

private:
    struct Value {
        double excess;
        double slope;
    };
    Value excess(double cost, std::span<const double> point) const;

    double linear_;
    double log_linear_;
    std::vector<ExponentialTerm> terms_;
    bool is_convex_ = true;
    std::vector<double> logs_;    // by term, of its absolute value at the point, less the largest
    std::vector<double> masses_;  // their exponentials
    double linear_mass_ = 0;
    double point_error_ = 0;
    std::vector<double> levels_;
    std::vector<std::size_t> order_;
};

}  // namespace relax

#endif
