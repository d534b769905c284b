#ifndef RELAX_SEARCH_LINEARISATION_HPP
#define RELAX_SEARCH_LINEARISATION_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/network_bounds.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/open_list.hpp"
#include "relax/search/search_space.hpp"

namespace relax {

// Executability of primitive networks (the paper's Definition 4.2): finds the cheapest order of the tasks that respects
// the network's and can be executed from the initial state. An A* search of its own, since the question is NP-complete.
// States and rests of networks that no order completes are remembered from one network to the next: what can still be
// executed does not depend on how they were reached.
//
// A choice between the cases of an action counts as primitive: which case it is depends on the state.
class Linearisation {
public:
    Linearisation(const PricedProblem& priced, Progression& progression, NetworkBounds& bounds, Limits& limits)
        : priced_(priced),
          progression_(progression),
          bounds_(bounds),
          limits_(limits),
          nodes_(progression.networks(), bounds) {}

    struct Order {
        std::vector<SearchStep> steps;
        Cost cost;
    };

    // Returns the cheapest order, or nothing if there is none or `stop` says that a limit was reached.
    std::optional<Order> find(NetworkId network, std::optional<StopReason>& stop);
    // Whether there may be orders that cost `kMostCost` or more; they were left out.
    bool has_overflowed() const { return has_overflowed_; }

private:
    void reach(NodeId from, Cost g, const Successor& successor);
    std::vector<SearchStep> steps_to(NodeId node) const;

    const PricedProblem& priced_;
    Progression& progression_;
    NetworkBounds& bounds_;
    Limits& limits_;
    SearchSpace nodes_;
    SegmentedArray<std::uint32_t> seen_;  // by NodeId: the latest call that met the node, or kDeadEnd
    static constexpr std::uint32_t kDeadEnd = 0;
    std::uint32_t call_ = 0;
    bool has_overflowed_ = false;
    OpenList<NodeId> open_;
    std::vector<NodeId> met_;  // in this call
    std::vector<Successor> successors_;
};

}  // namespace relax

#endif
