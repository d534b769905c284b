#ifndef RELAX_VALUATIONS_EVAR_HPP
#define RELAX_VALUATIONS_EVAR_HPP

#include <cmath>

#include "relax/valuations/law_objective.hpp"

namespace relax {

// The entropic value at risk, in units of cost: steps times `step`. It is the infimum over all slopes a > 0 of
// (ln E e^(a C) + c) / a, c = ln(1 / (1 - level)), and the largest mean of a law whose Kullback-Leibler divergence from
// this one is at most c (Ahmadi-Javid 2012), for a level below 1. It rises in the increasing convex order, as every
// (ln E e^(a C)) / a does.
class EvarOfLaw final : public LawObjective {
public:
    EvarOfLaw(double level, double step) : divergence_(-std::log1p(-level)), step_(step) {}

    bool is_concave() const override { return true; }
    double value(const Law& law) const override;
    double bound(const Law& law, double more) const override;
    double bound_of_sum(const Law& law, FlooredLaw& other) const override;

private:
    double divergence_;
    double step_;
};

}  // namespace relax

#endif
