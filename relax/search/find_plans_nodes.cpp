// The nodes of FindPlans: how they are made, bounded and ordered.

#include <algorithm>
#include <cmath>

#include "relax/analysis/tdg_bound.hpp"
#include "relax/search/find_plans.hpp"

namespace relax {

namespace {

constexpr Cost kLastPriority = kMostCost - 1;  // of what is still worth a look

}  // namespace

// Returns the successor's node, unless it is known, cannot improve on the best plan, or is a goal: a network without
// tasks.
std::optional<NodeId> FindPlans::generate(NodeId parent, const Successor& successor) {
    ++statistics_.generated;
    const Cost cost = priced_.cost(successor.action, successor.due_parts);
    const Cost g = add_bounds(nodes_[parent].g, cost);
    const TaskNetworks& networks = progression_.networks();
    if (networks.is_impossible(successor.network) || is_beyond(g, bounds_[successor.network])) {
        return std::nullopt;
    }
    const auto known = nodes_.find(successor.state, successor.network);
    if (known && is_as_good(nodes_[*known], g, successor.network)) {
        return std::nullopt;
    }
    const NodeId id =
        known ? nodes_.replace(*known, successor.network, bounds_[successor.network] - bounds_[nodes_[*known].network])
              : nodes_.add(successor.state, successor.network);
    SearchNode& node = nodes_[id];
    node.reach(parent, g, successor.step);
    if (networks.is_empty(node.network)) {
        if (!cannot_improve(node)) {
            goal_ = id;
            statistics_.best = g;
        }
        return std::nullopt;
    }
    node.h = std::max(node.h, cheap_bound(nodes_[parent], cost, successor.network));
    return cannot_improve(node) ? std::nullopt : std::optional(id);
}

// Whether a known node is as good as reaching another network of its form at cost g: once the actions are executed that
// come at different places in the two. Among equals the one with fewer tasks is better, or executing these actions
// would lead back to where they started.
bool FindPlans::is_as_good(const SearchNode& known, Cost g, NetworkId network) {
    const TaskNetworks& networks = progression_.networks();
    const Cost cost_known = known.g + bounds_[known.network];
    const Cost cost = g + bounds_[network];
    return cost_known < cost || (cost_known == cost && networks.size(known.network) <= networks.size(network));
}

Cost FindPlans::cheap_bound(const SearchNode& parent, Cost cost, NetworkId network) {
    Cost bound = 0;
    if (options_.tdg_bound && options_.heuristic != HeuristicKind::Blind) {
        bound = bounds_[network];
    }
    if (options_.inherit_h) {
        bound = std::max(bound, parent.h - cost);
    }
    return bound;
}

// Whether nothing is left to be found with this much paid and at least this much to pay: it is a dead end, or costs
// more than can be told apart.
bool FindPlans::is_beyond(Cost g, Cost h) {
    const Cost f = add_bounds(g, h);
    has_overflowed_ = has_overflowed_ || f == kMostCost;
    return f >= kMostCost;
}

// No plan through this node is better than what is known.
bool FindPlans::cannot_improve(const SearchNode& node) {
    const Cost f = add_bounds(node.g, node.h);
    return is_beyond(node.g, node.h) || (options_.upper_bound && f >= *options_.upper_bound) ||
           (statistics_.best && f >= *statistics_.best);
}

// What is open has g + h below `kMostCost`. A large weight changes the order only: it drops nothing. The last priority
// is at most g + weight h and at least g + h, as every priority is. So the promise of `cutoff` holds with it, and what
// is popped can always improve on the best plan.
Cost FindPlans::priority(NodeId id) const {
    const SearchNode& node = nodes_[id];
    if (options_.algorithm == SearchAlgorithm::AStar) {
        return node.g + node.h;
    }
    if (node.h >= kInfinity) {
        return kInfinity;
    }
    const double product = std::ceil(options_.weight * static_cast<double>(node.h));
    const Cost weighted = product < static_cast<double>(kLastPriority) ? static_cast<Cost>(product) : kLastPriority;
    return std::min(add_bounds(node.g, std::max(node.h, weighted)), kLastPriority);
}

void FindPlans::push(NodeId id) {
    const SearchNode& node = nodes_[id];
    open_.push(id, priority(id), node.h, progression_.networks().size(node.network));
}

// The least cost that a plan through an open node can have.
Cost FindPlans::open_bound() const {
    Cost bound = kInfinity;
    for (const OpenList<NodeId>::Entry& entry : open_.entries()) {
        const SearchNode& node = nodes_[entry.id];
        if (!node.is_expanded) {
            bound = std::min(bound, node.g + node.h);
        }
    }
    return bound;
}

}  // namespace relax
