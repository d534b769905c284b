#include "relax/policies/envelope.hpp"

#include <cassert>

namespace relax {

void Envelope::assign(std::span<const PolicyNodeId> members, Outside outside) {
    for (const PolicyNodeId node : members_) {
        places_[node] = kOutside;
    }
    for (const PolicyNodeId node : around_) {
        places_[node] = kOutside;
    }
    places_.resize(graph_.size(), kOutside);
    members_.assign(members.begin(), members.end());
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
    find_targets();
    set_outside(outside);
    restore_stops();
}

void Envelope::find_targets() {
    around_.clear();
    targets_.clear();
    first_target_.clear();
    first_outcome_.clear();
    for (const PolicyNodeId member : members_) {
        const DecisionGraph::Node& node = graph_[member];
        first_target_.push_back(targets_.size());
        first_outcome_.push_back(node.count == 0 ? 0 : graph_.first_outcome(DecisionId(node.first)));
        for (const DecisionId decision : graph_.decisions_of(member)) {
            for (const PolicyNodeId to : graph_.successors(decision)) {
                if (places_[to] == kOutside) {
                    places_[to] = static_cast<std::uint32_t>(members_.size() + around_.size());
                    around_.push_back(to);
                }
                targets_.push_back(places_[to]);
            }
        }
    }
}

void Envelope::set_outside(Outside outside, const SegmentedArray<double>* given) {
    outside_ = outside;
    given_ = given;
    worths_.resize(members_.size());
    for (const PolicyNodeId node : around_) {
        worths_.push_back(worth_outside(node));
    }
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
