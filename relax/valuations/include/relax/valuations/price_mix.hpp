#ifndef RELAX_VALUATIONS_PRICE_MIX_HPP
#define RELAX_VALUATIONS_PRICE_MIX_HPP

#include <cstddef>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/cost.hpp"

namespace relax {

// Prices that are sums of other ones, in whole units: a plan costs at most the sum of its costs at those, in their
// units, each times its weight. So what completing a node costs at these prices bounds how cheap it can be at all of
// the others together, where each bound by itself is that of another completion.
struct PriceMix {
    const PricedProblem* prices;
    std::vector<double> weights;  // at least 0, one of them positive

    // By how much, in its units, a bound at these prices exceeds what follows from the bounds of each of the others;
    // rounded down.
    double rest(std::span<const Cost> least, Cost bound) const {
        constexpr double kSlack = 0x1p-48;
        double sum = 0;
        for (std::size_t price = 0; price < weights.size(); ++price) {
            sum += weights[price] * static_cast<double>(least[price]);
        }
        const auto whole = static_cast<double>(bound);
        return whole - sum - kSlack * whole;
    }
};

}  // namespace relax

#endif
