#include "relax/policies/policy_search.hpp"

#include <algorithm>
#include <cmath>

namespace relax {

namespace {

constexpr std::uint32_t kRoundsUntilIteration = 8;  // without an open node, while choices still change
constexpr std::uint32_t kQuietIterations = 4;       // then all that is explored is taken into the envelope ...
constexpr std::size_t kNearlyAll = 2;               // or as soon as it is no more than so many times as much
constexpr std::size_t kUpperGrowth = 8;             // of what is explored, until an upper worth is found again
constexpr std::size_t kPlunges = 1000;              // per round at least
constexpr std::uint32_t kRoundsAside = 64;          // from a node that is not the root

}  // namespace

PolicySearch::PolicySearch(DecisionSource& source, const PolicySearchOptions& options, Limits& limits,
                           PolicyStatistics& statistics)
    : source_(source),
      options_(options),
      limits_(limits),
      statistics_(statistics),
      envelope_(graph_),
      iteration_(limits),
      evaluation_(limits) {}

PolicySearchResult PolicySearch::run() {
    PolicySearchResult result;
    best_.reset();
    statistics_.upper = kNever;
    result.stop = run_within_limits([this]() -> std::optional<StopReason> {
        root_ = source_.add_root(graph_);
        note_costs();
        search();
        return std::nullopt;
    });
    if (result.stop && graph_.size() > 0) {
        const Limits::Grace grace(limits_);
        run_within_limits([this]() -> std::optional<StopReason> {
            improve_explored();
            return std::nullopt;
        });
    }
    result.statistics = statistics_;
    result.policy = best_;
    result.is_infinite = iteration_.found_infinite();
    result.is_undecided = iteration_.is_undecided();
    return result;
}

void PolicySearch::search() {
    quiet_rounds_ = quiet_iterations_ = 0;
    members_.clear();
    ++gathering_;
    while (true) {
        const bool has_met_open = explore();
        ++statistics_.rounds;
        note_lower();
        if (graph_[root_].lower == kNever) {
            return;
        }
        if (has_met_open) {
            quiet_rounds_ = quiet_iterations_ = 0;
            members_.clear();
            ++gathering_;
        }
        std::ranges::for_each(order_, [this](PolicyNodeId node) { gather(node); });
        if (has_met_open && hurries()) {
            expand_around();
        }
        if (!has_met_open && (!has_changed_ || ++quiet_rounds_ >= kRoundsUntilIteration)) {
            quiet_rounds_ = 0;
            if (++quiet_iterations_ >= kQuietIterations || explored_.size() <= kNearlyAll * members_.size()) {
                std::for_each(explored_.rbegin(), explored_.rend(), [this](PolicyNodeId node) { gather(node); });
            }
            if (improve_envelope() || graph_[root_].lower == kNever || is_near()) {
                return;
            }
            if (hurries()) {
                expand_around();
            }
        }
        if (statistics_.expanded >= next_upper_) {
            next_upper_ = kUpperGrowth * statistics_.expanded;
            improve_explored();
            if (is_near()) {
                return;
            }
        }
    }
}

void PolicySearch::explore_from(std::span<const PolicyNodeId> nodes) {
    const PolicyNodeId root = root_;
    for (const PolicyNodeId node : nodes) {
        root_ = node;
        for (std::uint32_t count = 0; count < kRoundsAside && explore(); ++count) {
        }
    }
    root_ = root;
}

// Go through the best policy once; says whether an open node was met.
bool PolicySearch::explore() {
    ++round_;
    order_.clear();
    frames_.clear();
    has_changed_ = false;
    plunges_left_ = std::max(kPlunges, statistics_.expanded / 2);
    bool has_met_open = false;
    enter(root_, has_met_open);
    while (!frames_.empty()) {
        Frame& frame = frames_.back();
        const DecisionId choice = graph_[frame.node].choice;
        if (choice != kStop) {
            const auto successors = graph_.successors(choice);
            if (frame.next < successors.size()) {
                enter(successors[frame.next++], has_met_open);
                continue;
            }
        }
        const PolicyNodeId node = frame.node;
        frames_.pop_back();
        back_up(node);
        order_.push_back(node);
    }
    return has_met_open;
}

void PolicySearch::enter(PolicyNodeId node, bool& has_met_open) {
    limits_.stop_if_reached();
    DecisionGraph::Node& entered = graph_[node];
    if (entered.visited == round_ || entered.is_done || entered.lower == kNever) {
        return;
    }
    entered.visited = round_;
    ++walked_;
    if (!entered.is_expanded) {
        if (entered.lower >= entered.stop) {
            return;  // it is known to be no better than stopping
        }
        const double bound = source_.bound(node, entered.lower);
        ++statistics_.evaluated;
        const bool has_risen = bound > entered.lower + slack_of(entered.lower);
        entered.lower = std::max(entered.lower, std::min(bound, entered.stop));
        statistics_.dead_ends += bound == kNever ? 1 : 0;
        has_met_open = has_met_open || entered.lower < entered.stop;
        if ((has_risen && !hurries()) || plunges_left_ == 0 || entered.lower >= entered.stop) {
            return;
        }
        --plunges_left_;
        expand(node);
        if (back_up(node) && !hurries()) {
            return;
        }
    }
    frames_.push_back({node, 0});
}

void PolicySearch::expand(PolicyNodeId node) {
    source_.decide(graph_, node, drafts_);
    graph_.expand(node, drafts_);
    explored_.push_back(node);
    note_costs();
    ++statistics_.expanded;
    statistics_.generated = graph_.size();
}

// Take the best decision by the lower worths, of equally good ones that with the least depth; says whether the node's
// own worth rose.
bool PolicySearch::back_up(PolicyNodeId node) {
    DecisionGraph::Node& backed = graph_[node];
    double least = backed.stop;
    DecisionId choice = kStop;
    float depth = 0;
    for (const DecisionId decision : graph_.decisions_of(node)) {
        const double worth = worth_of_decision(graph_, options_.recursion, decision,
                                               [this](PolicyNodeId to) { return graph_[to].lower; });
        const double slack = least == kNever ? 0 : slack_of(least);
        if (worth > least + slack || worth == kNever) {
            continue;
        }
        float below = 0;
        for (const PolicyNodeId to : graph_.successors(decision)) {
            below = std::max(below, graph_[to].depth);
        }
        if (worth < least - slack || below + 1 < depth) {
            choice = decision;
            depth = below + 1;
        }
        least = std::min(least, worth);
    }
    has_changed_ = has_changed_ || choice != backed.choice;
    backed.choice = choice;
    backed.depth = depth;
    const bool has_risen = least > backed.lower + slack_of(backed.lower);
    backed.lower = std::max(backed.lower, least);
    return options_.breaks_ties ? back_up_cost(node, has_risen) : has_risen;
}

// Of the decisions that are as good as the best, take the one that costs least; says whether the node's worth or cost
// rose.
bool PolicySearch::back_up_cost(PolicyNodeId node, bool has_risen) {
    DecisionGraph::Node& backed = graph_[node];
    const double most = backed.lower + kTieTolerance * std::max(1.0, std::abs(backed.lower));
    double least = backed.stop <= most ? 0 : kNever;
    DecisionId choice = backed.stop <= most ? kStop : backed.choice;
    if (least > 0) {
        for (const DecisionId decision : graph_.decisions_of(node)) {
            const double cost = worth_of_decision(graph_, Recursion::ExpectedCost, decision,
                                                  [this](PolicyNodeId to) { return costs_[to]; });
            if (cost < least && worth_of_decision(
                                    graph_, options_.recursion, decision,
                                    [this](PolicyNodeId to) { return graph_[to].lower; }) <= most) {
                least = cost;
                choice = decision;
            }
        }
    }
    has_changed_ = has_changed_ || choice != backed.choice;
    backed.choice = choice;
    const bool costs_more = least != kNever && least > costs_[node] + slack_of(costs_[node]);
    costs_[node] = has_risen || costs_more ? (least == kNever ? 0 : least) : costs_[node];
    return has_risen || costs_more;
}

// Nodes that are new cost nothing, as far as is known.
void PolicySearch::note_costs() {
    while (options_.breaks_ties && costs_.size() < graph_.size()) {
        costs_.push_back(0);
    }
}

// Find the best policy of the envelope.
void PolicySearch::improve(Outside outside) {
    constexpr std::uint64_t kPasses = 4;  // through the envelope, at a guess, besides those of the iteration
    ++statistics_.iterations;
    walked_ += kPasses * envelope_.size();
    const std::uint64_t before = iteration_.visited();
    iteration_.improve(envelope_, options_.recursion);
    walked_ += iteration_.visited() - before;
    if (options_.breaks_ties) {
        worths_.clear();
        for (std::uint32_t place = 0; place < envelope_.size(); ++place) {
            worths_.push_back(envelope_.worth(place));
        }
        iteration_.break_ties(envelope_, options_.recursion, outside == Outside::Lower ? &costs_ : nullptr);
    }
}

void PolicySearch::note_lower() { statistics_.lower = graph_[root_].lower; }

}  // namespace relax
