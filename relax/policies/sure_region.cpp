#include "relax/policies/sure_region.hpp"

#include <algorithm>

namespace relax {

void SureRegion::make_proper(Envelope& envelope) {
    find_arrivals(envelope);
    find_proper(envelope);
    if (std::ranges::all_of(is_proper_, [](bool is_proper) { return is_proper; })) {
        return;
    }
    is_in_.assign(envelope.size(), true);
    while (shrink(envelope)) {
    }
    for (std::uint32_t place = 0; place < envelope.size(); ++place) {
        if (!is_in_[place]) {
            envelope.choose(place, kStop);
            envelope.set_worth(place, kNever);
        }
    }
}

// For each place the decisions that may lead there.
void SureRegion::find_arrivals(const Envelope& envelope) {
    const DecisionGraph& graph = envelope.graph();
    const auto visit = [&](auto put) {
        for (std::uint32_t from = 0; from < envelope.size(); ++from) {
            limits_.stop_if_reached();
            for (const DecisionId decision : graph.decisions_of(envelope.node(from))) {
                for (const PolicyNodeId node : graph.successors(decision)) {
                    if (const std::uint32_t to = envelope.place(node); to < envelope.size()) {
                        put(to, Arrival{from, decision});
                    }
                }
            }
        }
    };
    ends_.assign(envelope.size() + 1, 0);
    visit([&](std::uint32_t to, const Arrival&) { ++ends_[to + 1]; });
    for (std::uint32_t place = 0; place < envelope.size(); ++place) {
        ends_[place + 1] += ends_[place];
    }
    arrivals_.resize(ends_.back());
    visit([&](std::uint32_t to, const Arrival& arrival) { arrivals_[ends_[to]++] = arrival; });
    std::rotate(ends_.begin(), ends_.end() - 1, ends_.end());  // each row's end has become its beginning
    ends_.front() = 0;
}

// From where the policy as it is ends where it is wanted with probability 1: the nodes from which none can be reached
// that fails, or from which no end can be reached.
void SureRegion::find_proper(const Envelope& envelope) {
    std::vector<bool> fails(envelope.size(), false);
    reaches_.assign(envelope.size(), false);
    for (std::uint32_t place = 0; place < envelope.size(); ++place) {
        bool has_failed = false;
        reaches_[place] = ends_well(envelope, place, has_failed);
        fails[place] = has_failed;
    }
    spread(envelope, reaches_, true);
    for (std::uint32_t place = 0; place < envelope.size(); ++place) {
        fails[place] = fails[place] || !reaches_[place];
    }
    spread(envelope, fails, true);
    is_proper_ = std::move(fails);
    is_proper_.flip();
}

// Whether a node's choice may lead at once to where it is wanted, and whether to where it is not.
bool SureRegion::ends_well(const Envelope& envelope, std::uint32_t place, bool& fails) const {
    if (envelope.choice(place) == kStop) {
        fails = envelope.stop(place) == kNever;
        return !fails;
    }
    bool ends = false;
    for (const PolicyNodeId node : envelope.successors(envelope.choice(place))) {
        if (envelope.place(node) >= envelope.size()) {
            const bool is_wanted = envelope.worth_outside(node) != kNever;
            ends = ends || is_wanted;
            fails = fails || !is_wanted;
        }
    }
    return ends;
}

// Add all places from which those that are reached can be reached by the policy.
void SureRegion::spread(const Envelope& envelope, std::vector<bool>& reached, bool follows_choices) {
    queue_.clear();
    for (std::uint32_t place = 0; place < envelope.size(); ++place) {
        if (reached[place]) {
            queue_.push_back(place);
        }
    }
    while (!queue_.empty()) {
        const std::uint32_t place = queue_.back();
        queue_.pop_back();
        for (std::uint32_t at = ends_[place]; at < ends_[place + 1]; ++at) {
            const auto [from, decision] = arrivals_[at];
            if (!reached[from] && (!follows_choices || envelope.choice(from) == decision)) {
                reached[from] = true;
                queue_.push_back(from);
            }
        }
    }
}

// Keep the nodes of W from which there is a way out within W; say whether some have none. Those that have one choose
// it.
bool SureRegion::shrink(Envelope& envelope) {
    reaches_.assign(envelope.size(), false);
    queue_.clear();
    const auto reach = [&](std::uint32_t place, DecisionId decision) {
        reaches_[place] = true;
        queue_.push_back(place);
        if (!is_proper_[place]) {
            envelope.choose(place, decision);
        }
    };
    for (std::uint32_t place = 0; place < envelope.size(); ++place) {
        limits_.stop_if_reached();
        if (!is_in_[place]) {
            continue;
        }
        if (is_proper_[place] || envelope.stop(place) != kNever) {
            reach(place, kStop);
            continue;
        }
        for (const DecisionId decision : envelope.graph().decisions_of(envelope.node(place))) {
            bool leads_out = false;
            if (stays(envelope, decision, leads_out) && leads_out) {
                reach(place, decision);
                break;
            }
        }
    }
    for (std::size_t next = 0; next < queue_.size(); ++next) {  // in the order of their distance
        const std::uint32_t place = queue_[next];
        for (std::uint32_t at = ends_[place]; at < ends_[place + 1]; ++at) {
            const auto [from, decision] = arrivals_[at];
            bool leads_out = false;
            if (is_in_[from] && !reaches_[from] && stays(envelope, decision, leads_out)) {
                reach(from, decision);
            }
        }
    }
    const bool has_shrunk = queue_.size() < static_cast<std::size_t>(std::ranges::count(is_in_, true));
    is_in_ = reaches_;
    return has_shrunk;
}

// Whether a decision leads to nothing but W and what is wanted outside; and whether to the latter.
bool SureRegion::stays(const Envelope& envelope, DecisionId decision, bool& leads_out) const {
    for (const PolicyNodeId node : envelope.graph().successors(decision)) {
        const std::uint32_t place = envelope.place(node);
        if (place < envelope.size()) {
            if (!is_in_[place]) {
                return false;
            }
        } else if (envelope.worth_outside(node) == kNever) {
            return false;
        } else {
            leads_out = true;
        }
    }
    return true;
}

}  // namespace relax
