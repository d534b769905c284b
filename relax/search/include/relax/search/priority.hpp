#ifndef RELAX_SEARCH_PRIORITY_HPP
#define RELAX_SEARCH_PRIORITY_HPP

#include <algorithm>
#include <cmath>

#include "relax/base/cost.hpp"
#include "relax/search/search_node.hpp"

namespace relax {

// By what the open list is ordered: f = g + h, or g + weight h for weighted A* (Pohl 1970).
//
// Open nodes have g + h below `kMostCost`. A large weight only reorders them: the priority is at most g + weight h and
// at least g + h, and below `kMostCost`. Hence a search that ends when no open node has a priority below the cost of
// its best plan has found one that costs at most `weight` times the optimum: let a node on an optimal plan be open;
// best <= g + weight h <= weight (g + h) <= weight optimum.
class Priority {
public:
    explicit Priority(double weight) : weight_(weight) {}

    // Whether it is a lower bound of the cost of all plans through the node.
    bool is_f() const { return weight_ == 1; }

    Cost operator()(const SearchNode& node) const {
        if (is_f()) {
            return node.g + node.h;
        }
        if (node.h >= kInfinity) {
            return kInfinity;
        }
        const double product = std::ceil(weight_ * static_cast<double>(node.h));
        const Cost weighted = product < static_cast<double>(kLast) ? static_cast<Cost>(product) : kLast;
        return std::min(add_bounds(node.g, std::max(node.h, weighted)), kLast);
    }

private:
    static constexpr Cost kLast = kMostCost - 1;

    double weight_;
};

}  // namespace relax

#endif
