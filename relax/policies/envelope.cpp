#include "relax/policies/envelope.hpp"

#include <cassert>

namespace relax {

void Envelope::assign(std::span<const PolicyNodeId> members, Outside outside) {
    for (const PolicyNodeId node : members_) {
        places_[node] = kOutside;
    }
    places_.resize(graph_.size(), kOutside);
    members_.assign(members.begin(), members.end());
    set_outside(outside);
    barred_.clear();
    worths_.clear();
    choices_.clear();
    for (std::uint32_t place = 0; place < members_.size(); ++place) {
        const DecisionGraph::Node& node = graph_[members_[place]];
        assert(node.is_expanded && !node.is_done && places_[members_[place]] == kOutside);
        places_[members_[place]] = place;
        worths_.push_back(node.lower);
        choices_.push_back(node.choice);
    }
    restore_stops();
}

void Envelope::restore_stops() {
    stops_.clear();
    for (const PolicyNodeId node : members_) {
        stops_.push_back(graph_[node].stop);
    }
}

void Envelope::bar(std::uint32_t place, DecisionId decision) {
    if (barred_.empty()) {
        first_.clear();
        std::uint32_t count = 0;
        for (const PolicyNodeId node : members_) {
            first_.push_back(count);
            count += graph_[node].count;
        }
        barred_.assign(count, false);
    }
    barred_[first_[place] + (decision - graph_[members_[place]].first)] = true;
}

}  // namespace relax
