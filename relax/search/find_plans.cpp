#include "relax/search/find_plans.hpp"

#include <algorithm>
#include <new>
#include <ranges>
#include <utility>

#include "relax/analysis/tdg_bound.hpp"
#include "relax/search/plan_trace.hpp"

namespace relax {

namespace {

constexpr std::uint32_t kMostForcedSteps = 1000;  // recursion that is forced may have no end

constexpr std::uint64_t kWorkOfANode = 200;  // in operators that a heuristic looks at; by time, roughly

ProgressionOptions progression_options(const SearchOptions& options) {
    ProgressionOptions result = options;
    result.use_macros = options.merge_sequences;
    return result;
}

}  // namespace

FindPlans::FindPlans(const PricedProblem& priced, const SearchOptions& options, Limits& limits,
                     SearchStatistics& statistics)
    : priced_(priced),
      problem_(priced.problem),
      options_(options),
      limits_(limits),
      statistics_(statistics),
      progression_(priced.problem, priced.free_actions(), progression_options(options), limits),
      bounds_(progression_.networks(), priced.task_bounds(limits)),
      nodes_(progression_.networks()) {
    if (options.endings && !progression_.networks().are_totally_ordered()) {
        ending_.emplace(problem_, limits);
    }
    const bool asks_always = !options.selective;
    heuristics_.emplace_back(make_heuristic(options.heuristic, priced, limits), asks_always);
    for (const HeuristicKind kind : options.more_heuristics) {
        heuristics_.emplace_back(make_heuristic(kind, priced, limits), asks_always);
    }
}

bool FindPlans::advance(std::uint64_t work) {
    if (!problem_.solvable) {
        is_done_ = true;
    }
    if (is_done_) {
        return true;
    }
    try {
        if (nodes_.size() == 0) {
            start();
        }
        stop_ = search(work);
    } catch (const Stopped& stopped) {
        stop_ = stopped.reason;
    } catch (const std::bad_alloc&) {
        stop_ = StopReason::MemoryLimit;
    }
    is_done_ = is_done_ || stop_.has_value();
    if (!is_exact()) {
        statistics_.lower_bound = proven();
    }
    return is_done_;
}

std::uint64_t FindPlans::work() const {
    std::uint64_t work = statistics_.generated * kWorkOfANode + progression_.work() + (ending_ ? ending_->work() : 0);
    for (const SelectiveHeuristic& heuristic : heuristics_) {
        work += heuristic->work();
    }
    return work;
}

// No plan that is wanted costs less than this: each that was not found goes through an open node. In the middle of an
// expansion the open list is not complete.
Cost FindPlans::proven() const {
    const Cost wanted = options_.upper_bound.value_or(has_overflowed_ ? kMostCost : kInfinity);
    const Cost by_nodes = is_expanding_ ? 0 : std::min(open_bound(), wanted);
    return std::max(by_nodes, std::min(statistics_.lower_bound.value_or(0), wanted));
}

SearchResult FindPlans::result() {
    SearchResult result;
    if (!problem_.solvable) {
        return result;
    }
    const Limits::Grace grace(limits_);
    const Cost bound = goal_ ? std::min(proven(), *statistics_.best) : proven();
    result.stop = stop_;
    if (goal_) {
        trace_plan(priced_, progression_, nodes_, *goal_, limits_, result);
    }
    if (result.cost) {
        statistics_.best = result.cost;
        statistics_.lower_bound = std::min(bound, *result.cost);
        result.status = bound >= *result.cost ? SearchStatus::Optimal : SearchStatus::Solved;
    } else if (!is_done_ || result.stop || bound < options_.upper_bound.value_or(kInfinity)) {
        statistics_.lower_bound = bound;
        result.status = result.stop ? status_of(*result.stop) : SearchStatus::GaveUp;
    } else {
        statistics_.lower_bound.reset();
        result.status = SearchStatus::Unsolvable;
    }
    result.statistics = statistics_;
    return result;
}

void FindPlans::start() {
    const NodeId root = nodes_.add(progression_.initial_state(), progression_.initial_network());
    push(root);
}

// Search until the best plan is as good as the algorithm promises, or nothing is open, or the work is done. Says why it
// was stopped before that.
std::optional<StopReason> FindPlans::search(std::uint64_t most_work) {
    while (!open_.is_empty() && open_.top().priority < cutoff()) {
        if (work() >= most_work) {
            return std::nullopt;
        }
        if (const auto stop = limits_.check()) {
            return stop;
        }
        const OpenList<NodeId>::Entry entry = open_.pop();
        if (is_stale(entry)) {
            continue;
        }
        if (is_exact()) {
            statistics_.lower_bound = std::max(statistics_.lower_bound.value_or(0), entry.priority);
        }
        is_expanding_ = true;
        const auto node = follow(entry.id);
        if (node && priority(*node) > entry.priority) {
            push(*node);
        } else if (node && evaluate(*node, entry.priority)) {
            expand(*node);
        }
        is_expanding_ = false;
    }
    is_done_ = true;
    return std::nullopt;
}

// The priority from which nothing that is open is worth a look. Weighted search has kept its promise then: with
// g + weight h at least the cost of the best plan for every open node, weight (g + h) is as well.
Cost FindPlans::cutoff() const {
    return std::min(goal_ ? *statistics_.best : kInfinity, options_.upper_bound.value_or(kInfinity));
}

// The node has been expanded, or priced anew, since the entry was made.
bool FindPlans::is_stale(const OpenList<NodeId>::Entry& entry) const {
    const SearchNode& node = nodes_[entry.id];
    return node.is_expanded || node.h != entry.h || priority(entry.id) != entry.priority;
}

// Ask the heuristics that have not been asked about this pair of state and network, until one of them raises f. Returns
// whether none does; else the node is a dead end or goes back to the open list.
bool FindPlans::evaluate(NodeId id, Cost f) {
    SearchNode& node = nodes_[id];
    if (!can_end(node)) {
        ++statistics_.dead_ends;
        node.h = kInfinity;
        return false;
    }
    while (node.heuristics_asked < heuristics_.size()) {
        SelectiveHeuristic& heuristic = heuristics_[node.heuristics_asked++];
        if (!heuristic.is_worth_asking()) {
            continue;
        }
        const std::uint64_t cuts_before = heuristic->rounds();
        const auto h = ask(heuristic, id);
        ++statistics_.evaluated;
        statistics_.cuts += heuristic->rounds() - cuts_before;
        heuristic.note_answer(!h || *h > node.h, work_of_a_node(heuristic));
        if (!h) {
            ++statistics_.dead_ends;
            node.h = kInfinity;
            return false;
        }
        node.h = std::max(node.h, *h);
        if (cannot_improve(node)) {
            return false;
        }
        if (priority(id) > f) {
            push(id);
            return false;
        }
    }
    return true;
}

// A node whose evaluation is cut short stays open.
std::optional<Cost> FindPlans::ask(SelectiveHeuristic& heuristic, NodeId id) {
    try {
        NodeView view = progression_.view(nodes_[id].state, nodes_[id].network);
        view.tdg_bound = bounds_[nodes_[id].network];
        return heuristic->evaluate(view);
    } catch (const Stopped&) {
        push(id);
        is_expanding_ = false;
        throw;
    }
}

bool FindPlans::can_end(const SearchNode& node) {
    return !ending_ || node.heuristics_asked > 0 || !ending_->is_worth_asking() ||
           ending_->is_possible(progression_.ordered_tasks(node.network));
}

// What a node has cost so far on average, this heuristic left out. The first one is always worth its work.
std::uint64_t FindPlans::work_of_a_node(const SelectiveHeuristic& heuristic) const {
    if (&heuristic == &heuristics_.front()) {
        return std::uint64_t{1} << 50;
    }
    return (work() - heuristic->work()) / std::max<std::uint64_t>(1, decided_);
}

void FindPlans::expand(NodeId id) {
    const Cost f = priority(id);
    nodes_[id].is_expanded = true;
    ++statistics_.expanded;
    ++decided_;
    progression_.expand(nodes_[id].state, nodes_[id].network, successors_);
    if (options_.learn_branching) {
        note_branching(id);
    }
    // Of equal nodes the newest comes first, and that is the one of the domain's first method.
    for (const Successor& successor : std::views::reverse(successors_)) {
        auto next = generate(id, successor);
        if (next && priority(*next) <= f) {
            next = follow(*next);
        }
        if (next) {
            push(*next);
        }
    }
}

void FindPlans::note_branching(NodeId id) {
    if (successors_.size() > 1 && successors_.front().step.method) {
        progression_.branching().note_decomposed(problem_.method_task[*successors_.front().step.method]);
    }
    while (nodes_[id].is_forced) {
        id = nodes_[id].parent;
    }
    if (const auto method = nodes_[id].step().method) {
        progression_.branching().note_survivor(*method);
    }
}

// Go on from a node as long as there is but one way and f stays as it is. Returns where that leads, unless to a dead
// end, a goal, in a circle, or to a node that is known or cannot improve on the best plan. The nodes between are never
// open, and no heuristic is asked about them.
std::optional<NodeId> FindPlans::follow(NodeId id) {
    const Cost f = priority(id);
    std::uint32_t step = 0;
    for (; options_.follow_forced && step < kMostForcedSteps && priority(id) <= f && !limits_.check(); ++step) {
        SearchNode& node = nodes_[id];
        if (node.is_followed || !progression_.expand_if_forced(node.state, node.network, forced_)) {
            node.is_followed = true;
            return id;
        }
        node.is_expanded = true;
        ++statistics_.expanded;
        const auto next = forced_.empty() ? std::nullopt : generate(id, forced_.front());
        if (!next) {
            return std::nullopt;
        }
        id = *next;
        nodes_[id].is_forced = true;
    }
    if (step > 0 && forced_cycle_.closes(nodes_, progression_.networks(), id)) {
        ++statistics_.dead_ends;
        nodes_[id].h = kInfinity;
        return std::nullopt;
    }
    return id;
}

}  // namespace relax
