#ifndef RELAX_SEARCH_CHEAP_BOUND_HPP
#define RELAX_SEARCH_CHEAP_BOUND_HPP

#include <algorithm>

#include "relax/base/ids.hpp"
#include "relax/search/search_options.hpp"

namespace relax {

// A lower bound of the cost to come after a step, before any heuristic is asked: the decomposition graph's, and the
// parent's less the cost of the step. (The parent's h is at most the cost of each plan that goes on with the step.)
inline Cost cheap_bound(const BoundSwitches& switches, const HeuristicInfo& heuristic, Cost network_bound,
                        Cost parent_h, Cost step_cost) {
    const bool asks_graph = switches.tdg_bound && !heuristic.is_blind;
    const Cost by_graph = asks_graph ? network_bound : 0;
    return switches.inherit_h ? std::max(by_graph, parent_h - step_cost) : by_graph;
}

}  // namespace relax

#endif
