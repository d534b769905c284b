#include "relax/search/plan_based.hpp"

#include <algorithm>
#include <utility>

#include "relax/analysis/tdg_bound.hpp"
#include "relax/search/plan_trace.hpp"

namespace relax {

namespace {

// By TaskId: the choices between cases of an action, whose methods are none of the domain's.
std::vector<bool> find_choices(const GroundProblem& problem) {
    std::vector<bool> is_choice(problem.task_count(), false);
    for (const MethodId method : problem.methods()) {
        if (problem.method_parts[method].empty()) {
            is_choice[problem.method_task[method]] = true;
        }
    }
    return is_choice;
}

// By TaskId: what a task adds to f; of a compound one nothing where the heuristic is blind.
std::vector<Cost> make_bounds(const PricedProblem& priced, const std::vector<bool>& is_choice,
                              const HeuristicInfo& heuristic, Limits& limits) {
    std::vector<Cost> bounds = priced.task_bounds(limits);
    for (const TaskId task : priced.problem.compounds()) {
        if (heuristic.is_blind && !is_choice[task]) {
            bounds[task] = 0;
        }
    }
    return bounds;
}

}  // namespace

PlanBased::PlanBased(const PricedProblem& priced, const PlanBasedOptions& options, Limits& limits,
                     SearchStatistics& statistics)
    : priced_(priced),
      problem_(priced.problem),
      options_(options),
      limits_(limits),
      statistics_(statistics),
      is_choice_(find_choices(priced.problem)),
      task_bounds_(make_bounds(priced, is_choice_, *options.heuristic, limits)),
      progression_(priced.problem, priced.free_actions(), ProgressionOptions{}, limits),
      bounds_(progression_.networks(), task_bounds_),
      linearisation_(priced, progression_, bounds_, limits),
      open_preconditions_(priced.problem, limits) {}

SearchResult PlanBased::run() {
    SearchResult result;
    if (!problem_.solvable) {
        return result;
    }
    const auto stop = run_within_limits([this] { return search(); });
    const Limits::Grace grace(limits_);
    result.stop = stop;
    if (solution_) {
        trace(result);
    }
    if (result.cost) {
        statistics_.best = result.cost;
        if (!stop) {
            statistics_.lower_bound = result.cost;
        }
        result.status = stop ? SearchStatus::Solved : SearchStatus::Optimal;
    } else if (result.stop) {
        result.status = status_of(*result.stop);
        if (solution_) {
            statistics_.lower_bound = std::min(statistics_.lower_bound.value_or(0), solution_->cost);
        }
    } else if ((has_overflowed_ || linearisation_.has_overflowed()) && !options_.upper_bound) {
        statistics_.lower_bound = kMostCost;
        result.status = SearchStatus::GaveUp;
    } else {
        statistics_.lower_bound.reset();
        result.status = SearchStatus::Unsolvable;
    }
    result.statistics = statistics_;
    return result;
}

// Search until the best solution is as good as anything open, or nothing is open. Says why it stopped before that.
std::optional<StopReason> PlanBased::search() {
    generate(NodeId{0}, progression_.initial_network(), {});  // 1 to 7
    while (!open_.is_empty()) {                               // 8
        if (const auto stop = limits_.check()) {
            return stop;
        }
        statistics_.lower_bound = open_.top().priority;
        if (solution_ && solution_->cost <= open_.top().priority) {
            return std::nullopt;
        }
        const NodeId here = open_.pop().id;  // 9
        look_at(nodes_[here].network);
        if (!compounds_.empty()) {
            expand(here);
        } else if (const auto stop = execute(here)) {  // 10
            return stop;
        }
    }
    return std::nullopt;
}

// List the tasks of a network, and its compound ones.
void PlanBased::look_at(NetworkId network) {
    progression_.networks().ordered_tasks(network, tasks_);
    compounds_.clear();
    for (std::uint32_t index = 0; index < tasks_.tasks.size(); ++index) {
        const TaskId task = tasks_.tasks[index];
        if (!problem_.is_primitive(task) && !is_choice_[task]) {
            compounds_.push_back({index, task});
        }
    }
}

void PlanBased::expand(NodeId node) {
    ++statistics_.expanded;
    if (!options_.branches_over_all) {
        const auto fewest = std::ranges::min_element(compounds_, {}, [this](const Occurrence& occurrence) {
            return problem_.methods_of(occurrence.task).size();
        });
        compounds_.assign(1, *fewest);
    }
    const NetworkId network = nodes_[node].network;
    for (const Occurrence& occurrence : std::vector(compounds_)) {
        for (const MethodId method : problem_.methods_of(occurrence.task)) {
            limits_.stop_if_reached();
            generate(node, progression_.networks().decompose(network, occurrence.index, method),
                     {occurrence.index, method});  // 12, 13
        }
    }
}

void PlanBased::generate(NodeId parent, NetworkId network, const SearchStep& step) {
    ++statistics_.generated;
    if (network >= is_known_.size()) {
        is_known_.resize(std::max<std::size_t>(network + 1, 2 * is_known_.size()), false);
    }
    if (is_known_[network]) {  // 20
        return;
    }
    is_known_[network] = true;        // 22
    const Cost f = bounds_[network];  // 14 to 19
    look_at(network);
    Cost h = 0;
    for (const Occurrence& occurrence : compounds_) {
        h = add_bounds(h, task_bounds_[occurrence.task]);
    }
    if (h >= kInfinity || (options_.checks_preconditions && !open_preconditions_.can_be_met(tasks_))) {
        ++statistics_.dead_ends;
        return;
    }
    if (f >= kMostCost) {
        has_overflowed_ = true;
        return;
    }
    if (options_.upper_bound && f >= *options_.upper_bound) {
        return;
    }
    // 20, 21
    open_.push(static_cast<NodeId>(nodes_.size()), f, h, static_cast<std::uint32_t>(tasks_.tasks.size()));
    nodes_.push_back({network, parent, step});
}

// Look for the cheapest order in which the primitive network can be executed. Where it costs more than f, which was a
// lower bound then, something else that is open may be better.
std::optional<StopReason> PlanBased::execute(NodeId node) {
    ++statistics_.evaluated;
    std::optional<StopReason> stop;
    auto order = linearisation_.find(nodes_[node].network, stop);
    if (order) {
        if (order->cost < (solution_ ? solution_->cost : options_.upper_bound.value_or(kInfinity))) {
            solution_ = {node, order->cost, std::move(order->steps)};
            statistics_.best = solution_->cost;
        }
    } else if (!stop) {
        ++statistics_.dead_ends;
    }
    return stop;
}

void PlanBased::trace(SearchResult& result) {
    std::vector<SearchStep> steps;
    for (NodeId id = solution_->node; nodes_[id].parent != id; id = nodes_[id].parent) {
        steps.push_back(nodes_[id].step);
    }
    std::reverse(steps.begin(), steps.end());
    steps.insert(steps.end(), solution_->order.begin(), solution_->order.end());
    trace_steps(priced_, progression_, steps, limits_, result);
}

}  // namespace relax
