#ifndef RELAX_VALUATIONS_LAW_OPTIONS_HPP
#define RELAX_VALUATIONS_LAW_OPTIONS_HPP

#include <cstddef>
#include <limits>

namespace relax {

// Each rule and each bound can be left out. All of them are sound (see law_orders.hpp, graph_of_laws.hpp).
struct LawOptions {
    bool stochastic_order = true;
    bool convex_order = true;  // where the objective is concave
    bool pairwise = true;      // rules that know the objective: laws are compared where it tells costs from each other
    bool least_bound = true;
    bool mean_bound = true;  // where the objective is concave
    bool graph_bound = true;
    bool graph_parts = true;  // what conditional parts of a cost come to in whatever state counts in the graph
    // Of the law of what a way has cost, where the objective is concave: it then is below the true one.
    std::size_t label_outcomes = std::numeric_limits<std::size_t>::max();
    std::size_t graph_outcomes = 2048;    // of each law of the graph at most ...
    std::size_t network_outcomes = 2048;  // ... and of the sums of them
};

}  // namespace relax

#endif
