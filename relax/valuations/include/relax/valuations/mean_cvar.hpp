#ifndef RELAX_VALUATIONS_MEAN_CVAR_HPP
#define RELAX_VALUATIONS_MEAN_CVAR_HPP

#include "relax/valuations/law_objective.hpp"

namespace relax {

// (1 - weight) E C + weight CVaR(C), in units of cost: steps times `step`. The conditional value at risk is the mean of
// the worst 1 - level of all cases, min over t of t + E max(C - t, 0) / (1 - level) (Rockafellar and Uryasev 2000), for
// a level below 1.
class MeanCvarOfLaw final : public LawObjective {
public:
    MeanCvarOfLaw(double level, double weight, double step) : tail_(1.0 - level), weight_(weight), step_(step) {}

    bool is_concave() const override { return true; }
    double value(const Law& law) const override { return step_ * steps(law); }
    double bound(const Law& law, double more) const override { return rounded_down(steps(law) + more); }
    double bound_of_sum(const Law& law, FlooredLaw& other) const override;

private:
    double steps(const Law& law) const;
    double rounded_down(double steps) const;

    double tail_;
    double weight_;
    double step_;
};

}  // namespace relax

#endif
