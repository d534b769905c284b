#ifndef RELAX_VALUATIONS_LAW_OBJECTIVE_HPP
#define RELAX_VALUATIONS_LAW_OBJECTIVE_HPP

#include "relax/valuations/law.hpp"
#include "relax/valuations/law_table.hpp"

namespace relax {

// What a law of a total cost is worth, minimised: a functional that is monotone in the usual stochastic order. Costs
// are in steps of the grid, values in the objective's own unit. Bounds are rounded down by more than sums of
// probabilities may be off; values are not.
class LawObjective {
public:
    virtual ~LawObjective() = default;

    // What nobody needs to know of laws in order to value them.
    virtual LawDetail detail() const { return {}; }
    // Whether it is monotone in the increasing convex order, too.
    virtual bool is_concave() const = 0;

    virtual double value(const Law& law) const = 0;
    // Of the law's cost and so many steps more.
    virtual double bound(const Law& law, double more) const = 0;
    // Of the sum of two independent costs.
    virtual double bound_of_sum(const Law& law, FlooredLaw& other) const = 0;

    // Whether each independent cost of at least `least` makes the one worth at most as much as the other, where the
    // orders of laws do not say so.
    virtual bool is_as_good(const Law& /*one*/, const Law& /*other*/, double /*least*/) const { return false; }
};

}  // namespace relax

#endif
