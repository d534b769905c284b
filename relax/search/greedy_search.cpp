#include "relax/search/greedy_search.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "relax/analysis/tdg_bound.hpp"
#include "relax/search/plan_trace.hpp"

namespace relax {

namespace {

constexpr std::int64_t kTurnsEarned = 1000;      // by preferred successors, whenever h falls below all before
constexpr std::uint32_t kLongestWalk = 1000;     // through nodes with a single successor: networks may grow without end
constexpr std::uint64_t kMoreEvaluations = 200;  // after the first plan, besides as many as it took
constexpr std::uint64_t kMoreWork = 30'000'000;  // likewise, at most

}  // namespace

GreedySearch::GreedySearch(const PricedProblem& priced, const GreedyOptions& options, Limits& limits,
                           SearchStatistics& statistics)
    : StepwiseSearch(priced, limits, statistics),
      options_(options),
      progression_(priced.problem, priced.free_actions(), {options, false, options.when_due, options.in_sequence},
                   limits),
      bounds_(progression_.networks(), priced.task_bounds(limits)),
      heuristic_(options.heuristic->make(priced, limits)),
      nodes_(progression_.networks(), bounds_),
      most_evaluations_(options.most_evaluations.value_or(std::numeric_limits<std::uint64_t>::max())) {
    incumbent_.cutoff = options.upper_bound.value_or(kInfinity);
}

std::uint64_t GreedySearch::work() const {
    return statistics_.generated * kWorkOfANode + progression_.work() + heuristic_->work();
}

SearchResult GreedySearch::result() {
    SearchResult result;
    if (!problem_.solvable) {
        return result;
    }
    const Limits::Grace grace(limits_);
    result.stop = stop_;
    statistics_.lower_bound = proven_;
    if (incumbent_.goal) {
        trace_plan(priced_, progression_, nodes_, *incumbent_.goal, limits_, result);
    }
    if (result.cost) {
        statistics_.best = result.cost;
        result.status = proven_ >= *result.cost ? SearchStatus::Optimal : SearchStatus::Solved;
        statistics_.lower_bound = std::min(proven_, *result.cost);
    } else if (result.stop) {
        result.status = status_of(*result.stop);
    } else if (!is_done_ || incumbent_.has_overflowed || options_.in_sequence ||
               statistics_.evaluated >= most_evaluations_) {
        result.status = SearchStatus::GaveUp;
    } else {
        result.status = SearchStatus::Unsolvable;
        statistics_.lower_bound.reset();
    }
    result.statistics = statistics_;
    return result;
}

// Search until there is a plan and time for it is up, or nothing is open, or the work is done. Says why it was stopped
// before that.
std::optional<StopReason> GreedySearch::search(std::uint64_t most_work) {
    if (nodes_.size() == 0) {
        proven_ = bounds_[progression_.initial_network()];
        open_.push(nodes_.add(progression_.initial_state(), progression_.initial_network()), 0, 0, 1);
    }
    while ((!open_.is_empty() || !preferred_.is_empty()) && statistics_.evaluated < most_evaluations_) {
        const std::uint64_t so_far = work();
        if (so_far >= most_work_) {
            break;
        }
        if (so_far >= most_work) {
            return std::nullopt;
        }
        if (const auto stop = limits_.check()) {
            return stop;
        }
        const NodeId popped = pop();
        if (nodes_[popped].is_expanded) {
            continue;
        }
        const auto node = follow(popped);
        if (!node) {
            continue;
        }
        explores_ = options_.explores && !explores_;
        const auto h = evaluate(*node);
        if (!h) {
            ++statistics_.dead_ends;
            continue;
        }
        if (!least_h_ || *h < *least_h_) {
            least_h_ = h;
            preferred_turns_ -= kTurnsEarned;
        }
        push_successors(*node, *h);
    }
    is_done_ = true;
    return std::nullopt;
}

// The lists take turns.
NodeId GreedySearch::pop() {
    if (explores_ && !types_.is_empty()) {
        return types_.pop();
    }
    if (open_.is_empty() || (!preferred_.is_empty() && preferred_turns_ <= turns_)) {
        ++preferred_turns_;
        return preferred_.pop().id;
    }
    ++turns_;
    return open_.pop().id;
}

// Expand the node and go on as long as there is a single successor. Returns the node where there are several, which
// are then in `successors_`; nothing where the walk ends at a dead end, in a cycle, at a node that is known, or at a
// goal.
std::optional<NodeId> GreedySearch::follow(NodeId node) {
    for (std::uint32_t steps = 0;; ++steps) {
        limits_.stop_if_reached();
        nodes_[node].is_expanded = true;
        ++statistics_.expanded;
        progression_.expand(nodes_[node].state, nodes_[node].network, successors_);
        if (successors_.size() > 1) {
            return node;
        }
        if (successors_.empty()) {
            return std::nullopt;
        }
        if (steps == kLongestWalk || limits_.check()) {
            return forced_cycle_.closes(nodes_, progression_.networks(), node) ? std::nullopt : std::optional(node);
        }
        const auto next = generate(node, successors_.front());
        if (!next) {
            return std::nullopt;
        }
        node = *next;
        nodes_[node].is_forced = true;
    }
}

std::optional<Cost> GreedySearch::evaluate(NodeId id) {
    const SearchNode& node = nodes_[id];
    ++statistics_.evaluated;
    NodeView view = progression_.view(node.state, node.network);
    view.tdg_bound = bounds_[node.network];
    const auto h = heuristic_->evaluate(view);
    statistics_.cuts = heuristic_->rounds();
    return h;
}

// Returns the successor's node, unless it is known, cannot improve on the best plan, or is a goal: a network without
// tasks.
std::optional<NodeId> GreedySearch::generate(NodeId parent, const Successor& successor) {
    ++statistics_.generated;
    const Cost g = add_bounds(nodes_[parent].g, priced_.cost(successor.action, successor.due_parts));
    if (incumbent_.overflows(g, 0)) {
        return std::nullopt;
    }
    if (const auto known = nodes_.find(successor.state, successor.network)) {
        if (g < nodes_[*known].g) {  // a cheaper way; what comes after it need not be seen again
            const bool is_expanded = nodes_[*known].is_expanded;
            nodes_[*known].reach(parent, g, successor.step);
            nodes_[*known].is_expanded = is_expanded;
        }
        return std::nullopt;
    }
    if (add_bounds(g, bounds_[successor.network]) >= incumbent_.cutoff) {
        return std::nullopt;
    }
    const NodeId id = nodes_.add(successor.state, successor.network);
    nodes_[id].reach(parent, g, successor.step);
    if (progression_.networks().is_empty(successor.network)) {
        if (!incumbent_.goal) {
            most_evaluations_ = 2 * statistics_.evaluated + kMoreEvaluations;
            most_work_ = work() + kMoreWork;
        }
        incumbent_.goal = id;
        incumbent_.cutoff = g;
        statistics_.best = g;
        return std::nullopt;
    }
    return id;
}

void GreedySearch::push_successors(NodeId parent, Cost h) {
    for (const Successor& successor : successors_) {
        const auto id = generate(parent, successor);
        if (!id) {
            continue;
        }
        const std::uint32_t size = progression_.networks().size(successor.network);
        open_.push(*id, h, size, size);
        if (options_.explores) {
            types_.push(*id, h, nodes_[*id].g);
        }
        if (!successor.step.method || heuristic_->is_preferred(*successor.step.method)) {
            preferred_.push(*id, h, size, size);
        }
    }
}

}  // namespace relax
