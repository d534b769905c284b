#ifndef RELAX_SEARCH_HEURISTIC_SEQUENCE_HPP
#define RELAX_SEARCH_HEURISTIC_SEQUENCE_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "relax/heuristics/selective_heuristic.hpp"
#include "relax/networks/network_bounds.hpp"
#include "relax/progression/ending.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/search_node.hpp"
#include "relax/search/search_options.hpp"
#include "relax/search/search_result.hpp"

namespace relax {

// The admissible heuristics of a search, asked about a node one after the other: the maximum of their answers is
// admissible, and the later ones need not be asked where an earlier one has put the node off.
class HeuristicSequence {
public:
    HeuristicSequence(const PricedProblem& priced, const FindPlansOptions& options, Progression& progression,
                      NetworkBounds& bounds, Limits& limits, SearchStatistics& statistics);  // throws Stopped

    // Ask the next heuristic that is worth it about the node, and raise h. False: there is none left. `work_so_far`:
    // what the search has done besides, to expand `expanded` nodes. Throws Stopped.
    bool raise_h(SearchNode& node, std::uint64_t work_so_far, std::uint64_t expanded);

    std::uint64_t work() const;

private:
    bool can_end(const SearchNode& node);
    std::uint64_t work_saved(const SelectiveHeuristic& heuristic, std::uint64_t work_so_far,
                             std::uint64_t expanded) const;

    Progression& progression_;
    NetworkBounds& bounds_;
    SearchStatistics& statistics_;
    std::optional<Ending> ending_;
    std::vector<SelectiveHeuristic> heuristics_;
};

}  // namespace relax

#endif
