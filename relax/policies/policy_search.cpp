#include "relax/policies/policy_search.hpp"

#include <algorithm>
#include <cmath>

namespace relax {

namespace {

constexpr std::uint32_t kRoundsUntilIteration = 8;  // without an open node, while choices still change
constexpr std::size_t kPlunges = 1000;              // per round at least

}  // namespace

PolicySearch::PolicySearch(DecisionSource& source, const PolicySearchOptions& options, Limits& limits,
                           PolicyStatistics& statistics)
    : source_(source),
      options_(options),
      limits_(limits),
      statistics_(statistics),
      envelope_(graph_),
      iteration_(limits) {}

PolicySearchResult PolicySearch::run() {
    PolicySearchResult result;
    result.stop = run_within_limits([this]() -> std::optional<StopReason> {
        root_ = source_.add_root(graph_);
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
    std::uint32_t quiet_rounds = 0;
    while (true) {
        const bool has_met_open = explore();
        ++statistics_.rounds;
        note_lower();
        if (graph_[root_].lower == kNever) {
            return;
        }
        quiet_rounds = has_met_open ? 0 : quiet_rounds + 1;
        if (!has_met_open && (!has_changed_ || quiet_rounds >= kRoundsUntilIteration)) {
            quiet_rounds = 0;
            if (improve_envelope() || graph_[root_].lower == kNever || is_near()) {
                return;
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
    if (!entered.is_expanded) {
        has_met_open = true;
        const double bound = source_.bound(node, entered.lower);
        ++statistics_.evaluated;
        const bool has_risen = bound > entered.lower + slack_of(entered.lower);
        entered.lower = std::max(entered.lower, std::min(bound, entered.stop));
        if (entered.lower == kNever) {
            ++statistics_.dead_ends;
        }
        if (has_risen || plunges_left_ == 0) {
            return;
        }
        --plunges_left_;
        expand(node);
        if (back_up(node)) {
            return;
        }
    }
    frames_.push_back({node, 0});
}

void PolicySearch::expand(PolicyNodeId node) {
    source_.decide(graph_, node, drafts_);
    graph_.expand(node, drafts_);
    explored_.push_back(node);
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
    return has_risen;
}

// Find the best policy of the nodes of the round, and make worths lower worths; says whether it is the best of all.
bool PolicySearch::improve_envelope() {
    ++statistics_.iterations;
    envelope_.assign(order_, Outside::Lower);
    iteration_.improve(envelope_, options_.recursion);
    for (std::uint32_t place = 0; place < envelope_.size(); ++place) {
        DecisionGraph::Node& node = graph_[envelope_.node(place)];
        node.lower = std::max(node.lower, envelope_.worth(place));
        node.choice = envelope_.choice(place);
    }
    note_lower();
    return keep_if_closed(kNever);
}

// Find the best policy of all that is explored.
void PolicySearch::improve_explored() {
    ++statistics_.iterations;
    std::vector<PolicyNodeId> members(explored_.rbegin(), explored_.rend());
    envelope_.assign(members, Outside::Stopped);
    PolicyIteration iteration(limits_);
    iteration.improve(envelope_, options_.recursion);
    keep_if_closed(0);
}

// Keep the envelope's policy if it does not leave it but to where it is done, and is better than the one that is kept.
// `slack`: if it is worse by no more than this.
bool PolicySearch::keep_if_closed(double slack) {
    const double worth = envelope_.worth_of(root_);
    if (worth == kNever || !(worth < statistics_.upper + slack)) {
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
    best_ = std::move(found);
    return true;
}

bool PolicySearch::is_near() const {
    const double lower = statistics_.lower * options_.unit;
    const double upper = statistics_.upper * options_.unit;
    return upper - lower <= options_.precision * std::max(1.0, std::abs(upper));
}

void PolicySearch::note_lower() { statistics_.lower = graph_[root_].lower; }

}  // namespace relax
