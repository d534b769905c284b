// The nodes of FindPlans: how they are made, bounded and ordered.

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "relax/find_plans.hpp"
#include "relax/tdg_bound.hpp"

namespace relax {

namespace {

constexpr Cost kDeadEnd = kNoDecomposition;

}  // namespace

// Returns the successor's node, unless it is known, too dear, or a goal: a network without tasks.
std::optional<NodeId> FindPlans::generate(NodeId parent, const Successor& successor) {
    ++statistics_.generated;
    const Cost g = nodes_[parent].g + successor.cost;
    if (g >= kDeadEnd) {
        throw std::overflow_error("the costs of a plan add up to more than 2^62 units");
    }
    const TaskNetworks& networks = progression_.networks();
    const Cost bound = networks.bound(successor.network);
    if (bound >= kDeadEnd || networks.is_impossible(successor.network)) {
        return std::nullopt;
    }
    const auto known = nodes_.find(successor.state, successor.network);
    if (known && is_as_good(nodes_[*known], g, successor.network)) {
        return std::nullopt;
    }
    const NodeId id =
        known ? nodes_.replace(*known, successor.network) : nodes_.add(successor.state, successor.network);
    if (guides_.size() < nodes_.size() && !is_admissible(options_.heuristic)) {
        guides_.push_back(guides_[known.value_or(parent)]);
    }
    SearchNode& node = nodes_[id];
    node.reach(parent, g, successor.step);
    if (networks.is_empty(node.network)) {
        if (!is_too_dear(node)) {
            goal_ = id;
            statistics_.best = g;
        }
        return std::nullopt;
    }
    node.h = std::max(node.h, cheap_bound(nodes_[parent], successor));
    return is_too_dear(node) ? std::nullopt : std::optional(id);
}

// Whether a known node is as good as reaching another network of its form at cost g: once the actions are executed that
// come at different places in the two. Among equals the one with fewer tasks is better, or executing these actions
// would lead back to where they started.
bool FindPlans::is_as_good(const SearchNode& known, Cost g, NetworkId network) {
    const TaskNetworks& networks = progression_.networks();
    const Cost cost_known = known.g + networks.bound(known.network);
    const Cost cost = g + networks.bound(network);
    return cost_known < cost || (cost_known == cost && networks.size(known.network) <= networks.size(network));
}

Cost FindPlans::cheap_bound(const SearchNode& parent, const Successor& successor) {
    Cost bound = 0;
    if (options_.use_tdg_bound && options_.heuristic != HeuristicKind::Blind) {
        bound = progression_.networks().bound(successor.network);
    }
    if (options_.inherit_h) {
        bound = std::max(bound, parent.h - successor.cost);
    }
    return bound;
}

// No plan through this node is better than what is known.
bool FindPlans::is_too_dear(const SearchNode& node) const {
    const Cost f = add_bounds(node.g, node.h);
    return f >= kDeadEnd || (options_.upper_bound && f >= *options_.upper_bound) ||
           (statistics_.best && f >= *statistics_.best);
}

Cost FindPlans::priority(NodeId id) const {
    const SearchNode& node = nodes_[id];
    const Cost estimate = is_admissible(options_.heuristic) ? node.h : std::max(node.h, guides_[id]);
    if (options_.algorithm == SearchAlgorithm::AStar) {
        return node.g + estimate;
    }
    const double weighted = std::ceil(options_.weight * static_cast<double>(estimate));
    return add_bounds(node.g, weighted < static_cast<double>(kDeadEnd) ? static_cast<Cost>(weighted) : kDeadEnd);
}

void FindPlans::push(NodeId id) {
    const SearchNode& node = nodes_[id];
    open_.push(id, priority(id), node.h, progression_.networks().size(node.network));
}

// The least cost that a plan through an open node can have.
Cost FindPlans::open_bound() const {
    Cost bound = kDeadEnd;
    for (const OpenList::Entry& entry : open_.entries()) {
        const SearchNode& node = nodes_[entry.node];
        if (!node.is_expanded) {
            bound = std::min(bound, node.g + node.h);
        }
    }
    return bound;
}

}  // namespace relax
