#ifndef RELAX_SEARCH_INCUMBENT_HPP
#define RELAX_SEARCH_INCUMBENT_HPP

#include <algorithm>
#include <optional>

#include "relax/base/cost.hpp"
#include "relax/search/search_node.hpp"

namespace relax {

// The best plan that a search has found, and which plans are wanted besides: those that cost less.
struct Incumbent {
    std::optional<NodeId> goal;   // where its plan ends, if it has one
    Cost cutoff = kInfinity;      // plans are wanted that cost less
    bool has_overflowed = false;  // a plan that costs `kMostCost` or more may have been left out

    // Whether no plan through a node is wanted, if `g` has been paid and at least `h` is still to pay.
    bool excludes(Cost g, Cost h) { return overflows(g, h) || add_bounds(g, h) >= cutoff; }

    // Whether there is no such plan, or it costs more than can be told from other costs.
    bool overflows(Cost g, Cost h) {
        const Cost f = add_bounds(g, h);
        has_overflowed = has_overflowed || f == kMostCost;
        return f >= kMostCost;
    }

    // What every plan costs that is wanted and goes through no open node.
    Cost bound_when_nothing_is_open() const { return std::min(cutoff, has_overflowed ? kMostCost : kInfinity); }
};

}  // namespace relax

#endif
