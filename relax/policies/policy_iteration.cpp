#include "relax/policies/policy_iteration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace relax {

namespace {

constexpr std::uint32_t kSweeps = 2;  // between two evaluations
constexpr std::uint32_t kMostRounds = 10000;

}  // namespace

void PolicyIteration::improve(Envelope& envelope, Recursion kind) {
    sure_region_.make_proper(envelope);
    const bool may_be_infinite = kind == Recursion::Averse || kind == Recursion::LogExpected;
    const LinearOutcome outcome = evaluation_.evaluate(envelope, kind);
    is_undecided_ = is_undecided_ || outcome == LinearOutcome::Undecided;
    if (outcome != LinearOutcome::Solved && may_be_infinite) {
        start_finite(envelope, kind);
    }
    iterate(envelope, kind);
}

void PolicyIteration::break_ties(Envelope& envelope, Recursion kind, const SegmentedArray<double>* outside) {
    for (std::uint32_t place = 0; place < envelope.size(); ++place) {
        limits_.stop_if_reached();
        const double most = envelope.worth(place) + kTieTolerance * std::max(1.0, std::abs(envelope.worth(place)));
        const bool stops = envelope.stop(place) <= most;
        if (stops) {
            envelope.choose(place, kStop);
        }
        for (const DecisionId decision : envelope.graph().decisions_of(envelope.node(place))) {
            if (stops || (decision != envelope.choice(place) && !(envelope.worth_by(place, kind, decision) <= most))) {
                envelope.bar(place, decision);
            }
        }
        envelope.set_stop(place, stops ? 0 : kNever);
    }
    envelope.set_outside(Outside::Given, outside);
    improve(envelope, Recursion::ExpectedCost);
}

// Give nodes a finite policy where there is one, and let the others stop. Those that have one keep it: among them, of
// sums of exponentials, are nodes where costs to come weigh less and less, and loops without an end look finite.
void PolicyIteration::start_finite(Envelope& envelope, Recursion kind) {
    bool may_stop_everywhere = true;
    std::vector<bool> is_sure(envelope.size());
    for (std::uint32_t place = 0; place < envelope.size(); ++place) {
        may_stop_everywhere = may_stop_everywhere && envelope.stop(place) != kNever;
        is_sure[place] = envelope.choice(place) != kStop || envelope.stop(place) != kNever;
    }
    if (!may_stop_everywhere) {
        const Outside outside = envelope.outside();
        envelope.set_outside(Outside::Reached);
        envelope.set_stops(0);
        for (std::uint32_t place = 0; place < envelope.size(); ++place) {
            if (envelope.worth(place) != kNever) {
                envelope.set_worth(place, -kNever);
                continue;
            }
            envelope.choose(place, kStop);
            envelope.set_worth(place, is_sure[place] ? 0 : kNever);
        }
        iterate(envelope, Recursion::Averse);
        note_near(envelope, is_sure);
        envelope.set_outside(outside);
        envelope.restore_stops();
        for (std::uint32_t place = 0; place < envelope.size(); ++place) {
            if (envelope.worth(place) != -kNever) {
                found_infinite_ = found_infinite_ || is_sure[place];
                envelope.choose(place, kStop);
            }
        }
    }
    evaluation_.evaluate(envelope, kind);
    stop_where_infinite(envelope, kind);
}

// Note whether some node has no finite policy only as far as floating point can tell. Where e^W is at least 1 / (1 + m)
// of Q e^W everywhere, the spectral radius of the policy of Q is at most 1 + m (Collatz and Wielandt); such policies
// are made of decisions that are worth W, or a bit more, and must be proper. Of radii a bit below 1 the evaluation says
// so.
void PolicyIteration::note_near(const Envelope& envelope, const std::vector<bool>& is_sure) {
    std::vector<bool> is_near(envelope.size());
    for (std::uint32_t place = 0; place < envelope.size(); ++place) {
        is_near[place] = is_sure[place] && envelope.worth(place) != -kNever && envelope.worth(place) != kNever;
    }
    while (true) {
        std::vector<bool> leaves(envelope.size());  // by decisions after which nothing but such nodes comes
        while (spread_near(envelope, is_near, leaves)) {
        }
        if (leaves == is_near) {
            break;
        }
        is_near = std::move(leaves);
    }
    is_undecided_ = is_undecided_ || std::ranges::find(is_near, true) != is_near.end();
}

// One round over the nodes; says whether one more can leave for where all is finite.
bool PolicyIteration::spread_near(const Envelope& envelope, const std::vector<bool>& is_near,
                                  std::vector<bool>& leaves) {
    const auto is_finite = [&](PolicyNodeId node) {
        const std::uint32_t at = envelope.place(node);
        return at >= envelope.size() || envelope.worth(at) == -kNever;
    };
    const auto leads_out = [&](std::uint32_t place, DecisionId decision) {
        const auto successors = envelope.graph().successors(decision);
        return !envelope.is_barred(place, decision) &&
               envelope.worth_by(place, Recursion::Averse, decision) <= envelope.worth(place) + kRadiusMargin &&
               std::ranges::all_of(successors, [&](auto to) { return is_finite(to) || is_near[envelope.place(to)]; }) &&
               std::ranges::any_of(successors, [&](auto to) { return is_finite(to) || leaves[envelope.place(to)]; });
    };
    bool has_changed = false;
    for (std::uint32_t place = 0; place < envelope.size(); ++place) {
        limits_.stop_if_reached();
        if (is_near[place] && !leaves[place] &&
            std::ranges::any_of(envelope.graph().decisions_of(envelope.node(place)),
                                [&](DecisionId decision) { return leads_out(place, decision); })) {
            leaves[place] = true;
            has_changed = true;
        }
    }
    return has_changed;
}

// Where it is allowed to stop, that is finite.
void PolicyIteration::stop_where_infinite(Envelope& envelope, Recursion kind) {
    bool stops = false;
    for (std::uint32_t place = 0; place < envelope.size(); ++place) {
        if (envelope.worth(place) == kNever && envelope.stop(place) != kNever) {
            envelope.choose(place, kStop);
            stops = true;
        }
    }
    if (stops) {
        evaluation_.evaluate(envelope, kind);
    }
}

// Component by component: what comes after it is settled by then.
void PolicyIteration::iterate(Envelope& envelope, Recursion kind) {
    std::uint32_t first = 0;
    for (const std::uint32_t end : envelope.component_ends()) {
        limits_.stop_if_reached();
        if (end == first + 1 && !envelope.has_loop(first)) {
            if (std::isfinite(envelope.worth(first))) {
                envelope.set_worth(first, envelope.worth_by(first, kind, envelope.choice(first)));
                choose_best(envelope, kind, first);
            }
        } else {
            iterate(envelope, kind, first, end);
        }
        first = end;
    }
}

void PolicyIteration::iterate(Envelope& envelope, Recursion kind, std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t round = 0; round < kMostRounds; ++round) {
        before_.clear();
        for (std::uint32_t place = first; place < end; ++place) {
            before_.push_back(envelope.worth(place));
        }
        std::uint32_t sweeps = 0;
        while (sweeps < kSweeps && sweep(envelope, kind, first, end)) {
            ++sweeps;
        }
        if (sweeps == 0) {
            return;
        }
        is_undecided_ = evaluation_.evaluate(envelope, kind, first, end) == LinearOutcome::Undecided || is_undecided_;
        visited_ += end - first;
        // Below rounding, worths may seem to fall again and again.
        bool has_fallen = false;
        for (std::uint32_t place = first; place < end && !has_fallen; ++place) {
            const double before = before_[place - first];
            has_fallen = envelope.worth(place) < before - slack_of(before);
        }
        if (!has_fallen) {
            return;
        }
    }
}

bool PolicyIteration::sweep(Envelope& envelope, Recursion kind, std::uint32_t first, std::uint32_t end) {
    bool has_changed = false;
    for (std::uint32_t place = first; place < end; ++place) {
        limits_.stop_if_reached();
        has_changed = choose_best(envelope, kind, place) || has_changed;
    }
    return has_changed;
}

// Let a node take the best decision, if that is better than its own; says whether it was.
bool PolicyIteration::choose_best(Envelope& envelope, Recursion kind, std::uint32_t place) {
    ++visited_;
    const double worth = envelope.worth(place);
    if (worth == kNever || worth == -kNever) {
        return false;
    }
    double best = worth - slack_of(worth);
    DecisionId choice = envelope.choice(place);
    bool is_better = false;
    const auto offer = [&](double offered, DecisionId decision) {
        if (offered < best) {
            best = offered;
            choice = decision;
            is_better = true;
        }
    };
    if (envelope.stop(place) != kNever) {
        offer(envelope.stop(place), kStop);
    }
    for (const DecisionId decision : envelope.graph().decisions_of(envelope.node(place))) {
        if (!envelope.is_barred(place, decision)) {
            offer(envelope.worth_by(place, kind, decision), decision);
        }
    }
    if (is_better) {
        envelope.set_worth(place, best);
        envelope.choose(place, choice);
    }
    return is_better;
}

}  // namespace relax
