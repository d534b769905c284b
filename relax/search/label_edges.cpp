#include "relax/search/label_edges.hpp"

#include <algorithm>

namespace relax {

namespace {

constexpr std::uint32_t kMostForcedSteps = 1000;  // recursion that is forced may have no end

}  // namespace

LabelEdges::LabelEdges(const Valuation& valuation, const LabelSearchOptions& options, Progression& progression,
                       LabelSpace& labels, Limits& limits)
    : options_(options), progression_(progression), labels_(labels), limits_(limits) {
    for (const PricedProblem* const priced : valuation.prices()) {
        bounds_.emplace_back(progression_.networks(), priced->task_bounds(limits_));
    }
}

NodeId LabelEdges::node_at(StateId state, NetworkId network) {
    const NodeId node = labels_.find_node(state, network);
    for (std::size_t price = 0; options_.tdg_bound && price < bounds_.size(); ++price) {
        Cost& least = labels_.node(node).least[price];
        least = std::max(least, bounds_[price][network]);
    }
    return node;
}

void LabelEdges::find(NodeId node) {
    progression_.expand(labels_.node(node).state, labels_.node(node).network, successors_);
    edges_.clear();
    for (const Successor& successor : successors_) {
        steps_.clear();
        executions_.clear();
        if (const auto end = follow(successor)) {
            edges_.push_back(labels_.make_edge(node_at(end->state, end->network), steps_, executions_));
        }
    }
    labels_.set_edges(node, edges_);
}

// Go on from a successor as long as it has a single one itself: no label ends between, and no bound is asked for.
// Returns where that ends; nothing where it is a dead end.
std::optional<LabelEdges::Place> LabelEdges::follow(const Successor& successor) {
    take(successor);
    Place place{successor.state, successor.network};
    for (std::uint32_t step = 0; options_.follow_forced && step < kMostForcedSteps; ++step) {
        limits_.stop_if_reached();
        if (progression_.networks().is_empty(place.network) ||
            !progression_.expand_if_forced(place.state, place.network, forced_)) {
            break;
        }
        if (forced_.empty()) {
            return std::nullopt;
        }
        take(forced_.front());
        place = {forced_.front().state, forced_.front().network};
    }
    return place;
}

void LabelEdges::take(const Successor& successor) {
    steps_.push_back(successor.step);
    if (successor.action) {
        executions_.push_back({*successor.action, labels_.store(successor.due_parts)});
    }
}

}  // namespace relax
