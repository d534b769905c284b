#ifndef RELAX_ANALYSIS_PRICES_HPP
#define RELAX_ANALYSIS_PRICES_HPP

#include <vector>

#include "relax/base/ids.hpp"

namespace relax {

// What a ground problem costs this agent, in units, all at least 0. In a state an action costs its own price and those
// of its cost parts that are due there; its own price is therefore the least that it can cost.
struct Prices {
    std::vector<Cost> actions;  // by ActionId
    std::vector<Cost> parts;    // by CostPartId
};

}  // namespace relax

#endif
