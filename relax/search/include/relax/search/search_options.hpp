#ifndef RELAX_SEARCH_SEARCH_OPTIONS_HPP
#define RELAX_SEARCH_SEARCH_OPTIONS_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/heuristics/heuristic.hpp"
#include "relax/progression/progression.hpp"

namespace relax {

// PlanBased searches task networks alone, the others states and task networks. Portfolio: several searches in turn.
enum class SearchAlgorithm : std::uint8_t { AStar, Weighted, Greedy, PlanBased, Portfolio };

struct SearchOptions : ProgressionOptions {
    HeuristicKind heuristic = HeuristicKind::LmCut;
    // A* asks them, one by one, where those before leave f as it is; all are admissible.
    std::vector<HeuristicKind> more_heuristics;
    SearchAlgorithm algorithm = SearchAlgorithm::AStar;
    double weight = 1.0;               // of h, for Weighted; at least 1
    bool tdg_bound = true;             // bound nodes by the decomposition graph before the heuristic is asked
    bool inherit_h = true;             // a node's h is at least its parent's less the cost of the step
    bool selective = true;             // ask an admissible heuristic rarely while it tells no more than the cheap bound
    bool endings = true;               // leave out networks in partial order whose last actions cannot be executed
    bool merge_sequences = true;       // networks whose actions in a row need and change the same are the same
    bool learn_branching = true;       // decompose the task that has left the fewest nodes to expand so far
    bool follow_forced = true;         // pass through nodes with but one way to go on
    std::optional<Cost> upper_bound;   // only plans that cost less are wanted
    bool branches_over_all = false;    // PlanBased tries every compound task of a network, not one
    bool checks_preconditions = true;  // PlanBased leaves out networks with a precondition that cannot be met
    bool explores = true;              // Greedy takes every other node from the type-based list
    std::optional<std::uint64_t> most_evaluations;  // Greedy gives up after so many without a plan
    // Portfolio: the searches that take turns, each a sequence of stages, of which a later one begins when an earlier
    // one has given up.
    std::vector<std::vector<SearchOptions>> members;
};

}  // namespace relax

#endif
