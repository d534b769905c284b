#ifndef RELAX_VALUATIONS_TABULATED_DISUTILITY_HPP
#define RELAX_VALUATIONS_TABULATED_DISUTILITY_HPP

#include <utility>
#include <vector>

#include "relax/valuations/law_objective.hpp"

namespace relax {

// The expectation of a function of the total cost that is given by a table: of 0, 1, 2 .. steps. It does not fall.
// From the end of the table on it is taken as flat, which bounds it from below.
class TabulatedDisutility final : public LawObjective {
public:
    explicit TabulatedDisutility(std::vector<double> table);

    LawDetail detail() const override { return {.last = last_, .is_flat_beyond = true}; }
    bool is_concave() const override { return false; }
    double value(const Law& law) const override { return expectation(law, 0.0); }
    double bound(const Law& law, double more) const override { return expectation(law, more) - rounding_; }
    double bound_of_sum(const Law& law, FlooredLaw& other) const override;

private:
    double at(double cost) const { return table_[static_cast<std::size_t>(std::min(cost, last_))]; }
    double expectation(const Law& law, double more) const;

    std::vector<double> table_;
    double last_;
    double rounding_;
};

}  // namespace relax

#endif
