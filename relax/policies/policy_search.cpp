#include "relax/policies/policy_search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace relax {

namespace {

constexpr std::uint32_t kRoundsUntilIteration = 8;  // without an open node, while choices still change
constexpr std::uint32_t kQuietIterations = 4;       // then all that is explored is taken into the envelope
constexpr std::size_t kPlunges = 1000;              // per round at least

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
        gather(order_);
        if (has_met_open && hurries()) {
            expand_around();
        }
        if (!has_met_open && (!has_changed_ || ++quiet_rounds_ >= kRoundsUntilIteration)) {
            quiet_rounds_ = 0;
            if (++quiet_iterations_ >= kQuietIterations) {
                gather(explored_);
            }
            if (improve_envelope() || graph_[root_].lower == kNever || is_near()) {
                return;
            }
            if (hurries()) {
                expand_around();
            }
        }
        if (statistics_.expanded >= next_upper_) {
            next_upper_ = 2 * statistics_.expanded;
            improve_explored();
            if (is_near()) {
                return;
            }
        }
    }
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
    constexpr std::uint64_t kPasses = 8;  // through the envelope, at a guess
    ++statistics_.iterations;
    walked_ += kPasses * envelope_.size();
    iteration_.improve(envelope_, options_.recursion);
    if (options_.breaks_ties) {
        worths_.clear();
        for (std::uint32_t place = 0; place < envelope_.size(); ++place) {
            worths_.push_back(envelope_.worth(place));
        }
        iteration_.break_ties(envelope_, options_.recursion, outside == Outside::Lower ? &costs_ : nullptr);
    }
}

// Take nodes into the envelope.
void PolicySearch::gather(std::span<const PolicyNodeId> nodes) {
    for (const PolicyNodeId node : nodes) {
        DecisionGraph::Node& gathered = graph_[node];
        if (gathered.gathered != gathering_ && gathered.lower != kNever) {
            gathered.gathered = gathering_;
            members_.push_back(node);
        }
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

// Expand some of the open nodes to which decisions of the envelope lead.
void PolicySearch::expand_around() {
    constexpr std::size_t kShare = 2;  // of as many as the envelope has
    std::vector<PolicyNodeId> open;
    ++round_;
    for (auto node = members_.rbegin(); node != members_.rend() && open.size() <= members_.size() / kShare; ++node) {
        for (const DecisionId decision : graph_.decisions_of(*node)) {
            for (const PolicyNodeId to : graph_.successors(decision)) {
                DecisionGraph::Node& found = graph_[to];
                if (!found.is_expanded && found.visited != round_ && found.lower < found.stop) {
                    found.visited = round_;
                    open.push_back(to);
                }
            }
        }
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

void PolicySearch::note_lower() { statistics_.lower = graph_[root_].lower; }

}  // namespace relax
