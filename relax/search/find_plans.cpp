#include "relax/search/find_plans.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

#include "relax/search/cheap_bound.hpp"
#include "relax/search/learn_branching.hpp"
#include "relax/search/plan_trace.hpp"

namespace relax {

FindPlans::FindPlans(const PricedProblem& priced, const FindPlansOptions& options, Limits& limits,
                     SearchStatistics& statistics)
    : StepwiseSearch(priced, limits, statistics),
      options_(options),
      progression_(priced.problem, priced.free_actions(), {options, options.merge_sequences}, limits),
      bounds_(progression_.networks(), priced.task_bounds(limits)),
      heuristics_(priced, options, progression_, bounds_, limits, statistics),
      nodes_(progression_.networks(), bounds_),
      priority_(options.weight),
      forced_steps_(progression_, nodes_, priority_, limits, statistics) {
    incumbent_.cutoff = options.upper_bound.value_or(kInfinity);
}

std::optional<StopReason> FindPlans::search(std::uint64_t most_work) {
    if (nodes_.size() == 0) {
        push(nodes_.add(progression_.initial_state(), progression_.initial_network()));  // 1, 3
    }
    while (!open_.is_empty() && open_.top().priority < incumbent_.cutoff) {  // 5; 7: the goal comes next
        if (work() >= most_work) {
            return std::nullopt;
        }
        if (const auto stop = limits_.check()) {
            return stop;
        }
        const OpenList<NodeId>::Entry entry = open_.pop();  // 6
        if (is_stale(entry)) {
            continue;
        }
        if (priority_.is_f()) {
            statistics_.lower_bound = std::max(statistics_.lower_bound.value_or(0), entry.priority);
        }
        popped_ = entry.id;
        if (const auto node = follow(entry.id); node && keeps_priority(*node, entry.priority)) {
            expand(*node);
        }
        popped_.reset();
    }
    is_done_ = true;
    return std::nullopt;  // 8; 20
}

// The node has been expanded, or its g or h has changed, since the entry was made.
bool FindPlans::is_stale(const OpenList<NodeId>::Entry& entry) const {
    const SearchNode& node = nodes_[entry.id];
    return node.is_expanded || node.h != entry.h || priority_(node) != entry.priority;
}

// computeRCAdHeur of lines 2, 13 and 18: ask the heuristics about the node until its priority rises. Returns whether it
// stays as it is; otherwise the node goes back into the open list, unless there is no need.
bool FindPlans::keeps_priority(NodeId id, Cost priority) {
    SearchNode& node = nodes_[id];
    do {
        if (priority_(node) > priority) {
            if (!incumbent_.excludes(node.g, node.h)) {
                push(id);
            }
            return false;
        }
    } while (heuristics_.raise_h(node, work_without_heuristics(), decisions_));
    return true;
}

void FindPlans::expand(NodeId id) {
    const Cost priority = priority_(nodes_[id]);
    nodes_[id].is_expanded = true;
    ++statistics_.expanded;
    ++decisions_;
    progression_.expand(nodes_[id].state, nodes_[id].network, successors_);  // 9 to 12, 15 to 17
    if (options_.learn_branching) {
        learn_branching(progression_.branching(), problem_, nodes_, id, successors_);
    }
    // Of equal nodes the newest is popped first: let that be the one of the domain's first method.
    for (const Successor& successor : std::views::reverse(successors_)) {
        auto next = generate(id, successor);  // 13; 18
        if (next && priority_(nodes_[*next]) <= priority) {
            next = follow(*next);
        }
        if (next) {
            push(*next);  // 14; 19
        }
    }
}

std::optional<NodeId> FindPlans::follow(NodeId id) {
    if (!options_.follow_forced) {
        return id;
    }
    return forced_steps_.follow(
        id, [this](NodeId parent, const Successor& successor) { return generate(parent, successor); });
}

// Returns the successor's node, unless it is a goal, no plan through it is wanted, or a node as good is known.
std::optional<NodeId> FindPlans::generate(NodeId parent, const Successor& successor) {
    ++statistics_.generated;
    const Cost cost = priced_.cost(successor.action, successor.due_parts);
    const Cost g = add_bounds(nodes_[parent].g, cost);
    const Cost bound = bounds_[successor.network];
    const TaskNetworks& networks = progression_.networks();
    if (networks.is_impossible(successor.network) || incumbent_.overflows(g, bound)) {
        return std::nullopt;
    }
    const auto id = nodes_.add_if_better(successor.state, successor.network, g);
    if (!id) {
        return std::nullopt;
    }
    SearchNode& node = nodes_[*id];
    node.reach(parent, g, successor.step);
    if (networks.is_empty(node.network)) {  // 7
        if (!incumbent_.excludes(g, 0)) {
            incumbent_.goal = id;
            incumbent_.cutoff = g;
            statistics_.best = g;
        }
        return std::nullopt;
    }
    node.h = std::max(node.h, cheap_bound(options_, *options_.heuristics.front(), bound, nodes_[parent].h, cost));
    return incumbent_.excludes(g, node.h) ? std::nullopt : id;
}

void FindPlans::push(NodeId id) {
    const SearchNode& node = nodes_[id];
    open_.push(id, priority_(node), node.h, progression_.networks().size(node.network));
}

std::uint64_t FindPlans::work() const { return work_without_heuristics() + heuristics_.work(); }

std::uint64_t FindPlans::work_without_heuristics() const {
    return statistics_.generated * kWorkOfANode + progression_.work();
}

// No plan that is wanted costs less: each goes through an open node, or through the one that is being expanded.
Cost FindPlans::proven() const {
    Cost bound = incumbent_.bound_when_nothing_is_open();
    const auto take = [&](NodeId id) { bound = std::min(bound, nodes_[id].g + nodes_[id].h); };
    if (popped_) {
        take(*popped_);
    }
    for (const OpenList<NodeId>::Entry& entry : open_.entries()) {
        if (!nodes_[entry.id].is_expanded) {
            take(entry.id);
        }
    }
    return std::max(bound, std::min(statistics_.lower_bound.value_or(0), incumbent_.bound_when_nothing_is_open()));
}

SearchResult FindPlans::result() {
    SearchResult result;
    if (!problem_.solvable) {
        return result;
    }
    const Limits::Grace grace(limits_);
    const Cost bound = proven();
    result.stop = stop_;
    if (incumbent_.goal) {
        trace_plan(priced_, progression_, nodes_, *incumbent_.goal, limits_, result);  // 8
    }
    if (result.cost) {
        statistics_.best = result.cost;
        statistics_.lower_bound = std::min(bound, *result.cost);
        result.status = bound >= *result.cost ? SearchStatus::Optimal : SearchStatus::Solved;
    } else if (!is_done_ || result.stop || bound < incumbent_.cutoff) {
        statistics_.lower_bound = bound;
        result.status = result.stop ? status_of(*result.stop) : SearchStatus::GaveUp;
    } else {
        statistics_.lower_bound.reset();
        result.status = SearchStatus::Unsolvable;  // 20
    }
    result.statistics = statistics_;
    return result;
}

}  // namespace relax
