#include "relax/search/linearisation.hpp"

#include <algorithm>

#include "relax/analysis/tdg_bound.hpp"

namespace relax {

std::optional<Linearisation::Order> Linearisation::find(NetworkId network, std::optional<StopReason>& stop) {
    ++call_;
    open_ = {};
    met_.clear();
    reach(NodeId{0}, 0, {progression_.initial_state(), network, {}, std::nullopt, {}});
    while (!open_.is_empty()) {
        stop = limits_.check();
        if (stop) {
            return std::nullopt;
        }
        const NodeId here = open_.pop().id;
        if (nodes_[here].is_expanded) {
            continue;
        }
        nodes_[here].is_expanded = true;
        if (progression_.networks().is_empty(nodes_[here].network)) {
            return Order{steps_to(here), nodes_[here].g};
        }
        progression_.expand(nodes_[here].state, nodes_[here].network, successors_);
        for (const Successor& successor : successors_) {
            reach(here, add_bounds(nodes_[here].g, priced_.cost(successor.action, successor.due_parts)), successor);
        }
    }
    // What was left out for its cost may be reached at a lower one from another network.
    for (std::size_t at = 0; !has_overflowed_ && at < met_.size(); ++at) {
        seen_[met_[at]] = kDeadEnd;
    }
    return std::nullopt;
}

void Linearisation::reach(NodeId from, Cost g, const Successor& successor) {
    if (g >= kMostCost) {
        has_overflowed_ = true;
        return;
    }
    const auto known = nodes_.find(successor.state, successor.network);
    const NodeId id = known ? *known : nodes_.add(successor.state, successor.network);
    if (!known) {
        seen_.push_back(call_);
        met_.push_back(id);
    } else if (seen_[id] == kDeadEnd || (seen_[id] == call_ && nodes_[id].g <= g)) {
        return;
    } else if (seen_[id] != call_) {
        seen_[id] = call_;
        met_.push_back(id);
    }
    nodes_[id].reach(met_.size() == 1 ? id : from, g, successor.step);
    const Cost h = bounds_[successor.network];
    open_.push(id, add_bounds(g, h), h, progression_.networks().size(successor.network));
}

std::vector<SearchStep> Linearisation::steps_to(NodeId node) const {
    std::vector<SearchStep> steps;
    for (; nodes_[node].parent != node; node = nodes_[node].parent) {
        steps.push_back(nodes_[node].step());
    }
    std::reverse(steps.begin(), steps.end());
    return steps;
}

}  // namespace relax
