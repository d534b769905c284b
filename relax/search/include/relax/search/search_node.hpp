#ifndef RELAX_SEARCH_SEARCH_NODE_HPP
#define RELAX_SEARCH_SEARCH_NODE_HPP

#include <cstdint>
#include <limits>
#include <optional>

#include "relax/base/ids.hpp"
#include "relax/progression/progression.hpp"

namespace relax {

using NodeId = Id<struct NodeTag>;

// A state and a network, and the cheapest path to them that is known.
struct SearchNode {
    Cost g;
    Cost h;  // a lower bound of the cost to come
    StateId state;
    NetworkId network;
    NodeId parent;  // itself for the root
    std::uint32_t occurrence;
    MethodId method;                // kExecuted where the step executed an action
    std::uint8_t heuristics_asked;  // how many; `h` includes what they told
    bool is_expanded;               // at its present g
    bool is_forced;                 // its parent has no other successor
    bool has_several_successors;    // as far as is known

    static constexpr MethodId kExecuted{std::numeric_limits<std::uint32_t>::max()};

    void reach(NodeId from, Cost cost, const SearchStep& step) {
        parent = from;
        g = cost;
        occurrence = step.occurrence;
        method = step.method.value_or(kExecuted);
        is_expanded = false;
        is_forced = false;
    }
    SearchStep step() const { return {occurrence, method == kExecuted ? std::nullopt : std::optional(method)}; }
};
static_assert(sizeof(SearchNode) == 40);

}  // namespace relax

#endif
