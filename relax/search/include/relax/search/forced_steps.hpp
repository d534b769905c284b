#ifndef RELAX_SEARCH_FORCED_STEPS_HPP
#define RELAX_SEARCH_FORCED_STEPS_HPP

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "relax/base/limits.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/forced_cycle.hpp"
#include "relax/search/priority.hpp"
#include "relax/search/search_result.hpp"
#include "relax/search/search_space.hpp"

namespace relax {

// Goes on from a node as long as it has a single successor and the priority does not rise. The nodes between are never
// open, and no heuristic is asked about them: their only successor says it all.
class ForcedSteps {
public:
    using Generate = std::function<std::optional<NodeId>(NodeId parent, const Successor&)>;

    ForcedSteps(Progression& progression, SearchSpace& nodes, const Priority& priority, Limits& limits,
                SearchStatistics& statistics)
        : progression_(progression), nodes_(nodes), priority_(priority), limits_(limits), statistics_(statistics) {}

    // Returns where the steps lead; nothing where that is a dead end, or `generate` returns nothing. Throws Stopped.
    std::optional<NodeId> follow(NodeId id, const Generate& generate);

private:
    Progression& progression_;
    SearchSpace& nodes_;
    const Priority& priority_;
    Limits& limits_;
    SearchStatistics& statistics_;
    ForcedCycle forced_cycle_;
    std::vector<Successor> successors_;
};

}  // namespace relax

#endif
