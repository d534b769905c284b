#ifndef RELAX_POLICIES_DISUTILITY_TERMS_HPP
#define RELAX_POLICIES_DISUTILITY_TERMS_HPP

#include <span>

namespace relax {

// ln(e^one + e^other)
double log_sum(double one, double other);

// One term of a disutility, but for its weight, as a function of the cost:
//
//     g(x) = (e^(a x) - 1) / a  for a slope a that is not 0,  and x for the slope 0.
//
// It is 0 at 0, and rises by 1 there. What is spent already changes it to a line in what it is of the cost to come,
// `g(s + x) = g(s) + e^(a s) g(x)`; so the expected term of costs to come follows from those of the next nodes, and
// policies are good for it whatever was spent.
//
// What is carried over is the logarithm of `base + g`, for no weight and no exponential to be too large for a float.
// The base, at most 1 / a, is there lest it be -infinity at 0, and of the size of the costs lest digits be lost. Then
//
//     base + g(s + x) = (1 - base a) g(s) + e^(a s) (base + g(x)).
//
// Where all slopes are negative, the sum does not rise without end: digits are lost at large costs instead. Then the
// base may be 1 / a, which makes e^(a x) of it but for a factor below 0: of that the size is carried over, and as it
// falls in the cost, worths are minus its logarithm (Recursion::Seeking).
struct DisutilityTerm {
    double slope;
    double log_weight;
    double base;

    // With a base that is not larger than a step of costs; or, where risk is only sought, with the base 1 / a.
    static DisutilityTerm of(double slope, double log_weight, double step, bool is_only_sought = false);

    bool is_only_sought() const { return base < 0; }
    // ln |base + g(cost)|; without the weight, as all that follows.
    double log_at(double cost) const;
    // ln of `(1 - base a) g(spent)`: -infinity where that is 0.
    double log_constant(double spent) const;
    // ln of `e^(a s)`.
    double log_factor(double spent) const { return slope * spent; }
};

// What a certain cost is worth: ln of the sum of weight * (base + g) over the terms; minus ln of its size where risk is
// only sought.
double worth_of(std::span<const DisutilityTerm> terms, double cost);
// The certain cost that is worth so much, to the last bit: 0 where it is less, infinite where it is more than any.
double certain_cost(std::span<const DisutilityTerm> terms, double worth);

}  // namespace relax

#endif
