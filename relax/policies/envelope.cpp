#include "relax/policies/envelope.hpp"

#include <algorithm>
#include <cassert>

namespace relax {

void Envelope::assign(std::span<const PolicyNodeId> members, Outside outside) {
    take(members);
    find_components();
    take(ordered_);
    barred_.clear();
    worths_.clear();
    choices_.clear();
    for (const PolicyNodeId member : members_) {
        worths_.push_back(graph_[member].lower);
        choices_.push_back(graph_[member].choice);
    }
    set_outside(outside);
    restore_stops();
}

// Give members their places in this order, and find out where their decisions lead.
void Envelope::take(std::span<const PolicyNodeId> members) {
    for (const PolicyNodeId node : members_) {
        places_[node] = kOutside;
    }
    for (const PolicyNodeId node : around_) {
        places_[node] = kOutside;
    }
    places_.resize(graph_.size(), kOutside);
    members_.assign(members.begin(), members.end());
    for (std::uint32_t place = 0; place < members_.size(); ++place) {
        assert(graph_[members_[place]].is_expanded && !graph_[members_[place]].is_done);
        assert(places_[members_[place]] == kOutside);
        places_[members_[place]] = place;
    }
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
    first_target_.push_back(targets_.size());
}

void Envelope::find_components() {
    ordered_.clear();
    component_ends_.clear();
    std::vector<std::uint32_t> places;
    components_.find(
        size(), [this](std::uint32_t place) { return targets(place); },
        [&](std::span<const std::uint32_t> component) {
            places.assign(component.begin(), component.end());
            std::ranges::sort(places);
            for (const std::uint32_t place : places) {
                ordered_.push_back(members_[place]);
            }
            component_ends_.push_back(static_cast<std::uint32_t>(ordered_.size()));
        });
}

bool Envelope::has_loop(std::uint32_t place) const {
    const auto all = targets(place);
    return std::ranges::find(all, place) != all.end();
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
