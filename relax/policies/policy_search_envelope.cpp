// What a policy search makes of its envelope: the best policy there, and whether it is one of the whole graph.

#include <algorithm>
#include <cmath>
#include <iterator>

#include "relax/policies/policy_search.hpp"

namespace relax {

// Take a node into the envelope.
void PolicySearch::gather(PolicyNodeId node) {
    DecisionGraph::Node& gathered = graph_[node];
    if (gathered.gathered != gathering_ && gathered.lower != kNever) {
        gathered.gathered = gathering_;
        members_.push_back(node);
    }
}

// Find the best policy of the nodes gathered, and make worths lower worths; says whether it is the best of all.
bool PolicySearch::improve_envelope() {
    std::erase_if(members_, [this](PolicyNodeId node) { return graph_[node].lower == kNever; });
    envelope_.assign(members_, Outside::Lower);
    improve(Outside::Lower);
    for (std::uint32_t place = 0; place < envelope_.size(); ++place) {
        DecisionGraph::Node& node = graph_[envelope_.node(place)];
        node.choice = envelope_.choice(place);
        if (options_.breaks_ties) {
            costs_[envelope_.node(place)] = envelope_.worth(place);
        }
        node.lower = std::max(node.lower, options_.breaks_ties ? worths_[place] : envelope_.worth(place));
    }
    note_lower();
    return keep_if_closed(Outside::Lower);
}

// Expand open nodes to which decisions of the envelope lead, those to which decisions of these lead, and so on: as many
// as the envelope has, so that all envelopes together are not much more than the last one.
void PolicySearch::expand_around() {
    ++round_;
    std::vector<PolicyNodeId> from(members_.rbegin(), members_.rend());
    std::vector<PolicyNodeId> open;
    for (std::size_t left = members_.size(); left > 0 && !from.empty(); left -= std::min(left, open.size())) {
        open.clear();
        for (auto node = from.begin(); node != from.end() && open.size() < left; ++node) {
            list_open(*node, open);
        }
        for (const PolicyNodeId node : open) {
            limits_.stop_if_reached();
            DecisionGraph::Node& found = graph_[node];
            found.lower = std::max(found.lower, std::min(source_.bound(node, found.lower), found.stop));
            ++statistics_.evaluated;
            if (found.lower < found.stop) {
                expand(node);
                back_up(node);
            }
        }
        from = open;
    }
}

// Append the open nodes to which decisions of a node lead, if they were not met in this round.
void PolicySearch::list_open(PolicyNodeId node, std::vector<PolicyNodeId>& open) {
    for (const DecisionId decision : graph_.decisions_of(node)) {
        for (const PolicyNodeId to : graph_.successors(decision)) {
            DecisionGraph::Node& found = graph_[to];
            if (!found.is_expanded && found.visited != round_ && found.lower < found.stop) {
                found.visited = round_;
                open.push_back(to);
            }
        }
    }
}

// Find the best policy of all that is explored.
void PolicySearch::improve_explored() {
    std::vector<PolicyNodeId> members;
    std::copy_if(explored_.rbegin(), explored_.rend(), std::back_inserter(members),
                 [this](PolicyNodeId node) { return graph_[node].lower != kNever; });
    envelope_.assign(members, Outside::Stopped);
    improve(Outside::Stopped);
    keep_if_closed(Outside::Stopped);
}

// Keep the envelope's policy if it does not leave it but to where it stops, and is better than the one that is kept.
bool PolicySearch::keep_if_closed(Outside outside) {
    const double cost = envelope_.worth_of(root_);
    if (options_.breaks_ties) {  // its worth may be worse than the best one by as much as makes a tie
        envelope_.set_outside(outside);
        envelope_.restore_stops();
        evaluation_.evaluate(envelope_, options_.recursion);
    }
    const double worth = envelope_.worth_of(root_);
    if (worth == kNever || (outside == Outside::Stopped && !is_better(worth, cost))) {
        return false;
    }
    FoundPolicy found;
    std::vector<bool> is_listed(graph_.size(), false);
    const auto list = [&](PolicyNodeId node) {
        if (!is_listed[node]) {
            const std::uint32_t place = envelope_.place(node);
            is_listed[node] = true;
            found.nodes.push_back(node);
            found.choices.push_back(place < envelope_.size() ? envelope_.choice(place) : kStop);
        }
    };
    list(root_);
    for (std::size_t at = 0; at < found.nodes.size(); ++at) {
        const PolicyNodeId at_node = found.nodes[at];
        const bool is_outside = envelope_.place(at_node) >= envelope_.size();
        if (is_outside && envelope_.worth_outside(at_node) != graph_[at_node].stop) {
            return false;
        }
        for (const PolicyNodeId node : envelope_.successors(found.choices[at])) {
            list(node);
        }
    }
    statistics_.upper = worth;
    statistics_.cost = options_.breaks_ties ? cost : 0;
    best_ = std::move(found);
    return true;
}

bool PolicySearch::is_better(double worth, double cost) const {
    const double slack = options_.breaks_ties && statistics_.upper < kNever ? kTieTolerance : 0;
    return worth < statistics_.upper - slack || (worth <= statistics_.upper + slack && cost < statistics_.cost);
}

bool PolicySearch::is_near() const {
    if (statistics_.upper == kNever) {
        return false;
    }
    const auto are_near = [this](double lower, double upper) {
        return upper - lower <= options_.precision * std::max(1.0, std::abs(upper));
    };
    return are_near(statistics_.lower * options_.unit, statistics_.upper * options_.unit) &&
           (!options_.breaks_ties || are_near(costs_[root_], statistics_.cost));
}

}  // namespace relax
