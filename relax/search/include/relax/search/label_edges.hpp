#ifndef RELAX_SEARCH_LABEL_EDGES_HPP
#define RELAX_SEARCH_LABEL_EDGES_HPP

#include <optional>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/networks/network_bounds.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/label_space.hpp"
#include "relax/search/search_options.hpp"
#include "relax/valuations/valuation.hpp"

namespace relax {

// The edges of a label search. All labels of a node have the same successors: they are found once, and forced steps
// after them are followed at once.
class LabelEdges {
public:
    // Everything must live longer. Throws Stopped.
    LabelEdges(const Valuation& valuation, const LabelSearchOptions& options, Progression& progression,
               LabelSpace& labels, Limits& limits);

    // The node of a state and a network, with what the decomposition graph says of it.
    NodeId node_at(StateId state, NetworkId network);
    // Find those that leave a node. Throws Stopped.
    void find(NodeId node);
    // What completing a network costs at least at one of the prices, by the decomposition graph.
    Cost bound(std::size_t price, NetworkId network) { return bounds_[price][network]; }

private:
    struct Place {
        StateId state;
        NetworkId network;
    };

    std::optional<Place> follow(const Successor& successor);
    void take(const Successor& successor);

    const LabelSearchOptions& options_;
    Progression& progression_;
    LabelSpace& labels_;
    Limits& limits_;
    std::vector<NetworkBounds> bounds_;  // by price
    std::vector<Successor> successors_;
    std::vector<Successor> forced_;
    std::vector<SearchStep> steps_;  // of an edge, as are the executions
    std::vector<Execution> executions_;
    std::vector<Edge> edges_;
};

}  // namespace relax

#endif
