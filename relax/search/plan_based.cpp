#include "relax/search/plan_based.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "relax/search/label_search.hpp"
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

// By price and TaskId: what a task adds to f; of a compound one nothing where the heuristic is blind.
std::vector<std::vector<Cost>> make_bounds(const Valuation& valuation, const std::vector<bool>& is_choice,
                                           const HeuristicInfo& heuristic, Limits& limits) {
    std::vector<std::vector<Cost>> bounds;
    for (const PricedProblem* const priced : valuation.prices()) {
        bounds.push_back(priced->task_bounds(limits));
        for (const TaskId task : priced->problem.compounds()) {
            if (heuristic.is_blind && !is_choice[task]) {
                bounds.back()[task] = 0;
            }
        }
    }
    return bounds;
}

std::vector<NetworkBounds> make_network_bounds(const TaskNetworks& networks,
                                               const std::vector<std::vector<Cost>>& task_bounds) {
    std::vector<NetworkBounds> bounds;
    for (const std::vector<Cost>& of_tasks : task_bounds) {
        bounds.emplace_back(networks, of_tasks);
    }
    return bounds;
}

}  // namespace

PlanBased::PlanBased(const AnalysedProblem& problem, Valuation& valuation, const PlanBasedOptions& options,
                     Limits& limits, SearchStatistics& statistics)
    : problem_(problem),
      valuation_(valuation),
      options_(options),
      limits_(limits),
      statistics_(statistics),
      is_choice_(find_choices(problem)),
      task_bounds_(make_bounds(valuation, is_choice_, *options.heuristic, limits)),
      progression_(problem, valuation.free_actions(), ProgressionOptions{}, limits),
      bounds_(make_network_bounds(progression_.networks(), task_bounds_)),
      linearisation_(*valuation.prices().front(), progression_, bounds_.front(), limits),
      open_preconditions_(problem, limits) {
    if (problem.solvable) {
        valuation_.begin(progression_.networks(), limits_);
    }
    valuation_.set_cutoff(cutoff());
}

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
        statistics_.best = solution_->worth;
        if (!stop) {
            statistics_.lower_bound = cutoff();
        }
        result.status = stop ? SearchStatus::Solved : SearchStatus::Optimal;
    } else if (result.stop) {
        result.status = status_of(*result.stop);
        if (solution_) {
            statistics_.lower_bound = std::min(statistics_.lower_bound.value_or(solution_->worth), solution_->worth);
        }
    } else if ((has_overflowed_ || linearisation_.has_overflowed()) && !options_.upper_bound) {
        statistics_.lower_bound = valuation_.most();
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
        if (solution_ && cutoff() <= open_.top().priority) {
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
    is_known_[network] = true;       // 22
    const Worth f = bound(network);  // 14 to 19
    look_at(network);
    Cost h = 0;
    for (const Occurrence& occurrence : compounds_) {
        h = add_bounds(h, task_bounds_.front()[occurrence.task]);
    }
    if (h >= kInfinity || f == kNoWorth || (options_.checks_preconditions && !open_preconditions_.can_be_met(tasks_))) {
        ++statistics_.dead_ends;
        return;
    }
    if (f >= valuation_.most()) {
        has_overflowed_ = true;
        return;
    }
    if (options_.upper_bound && f >= *options_.upper_bound) {
        return;
    }
    // 20, 21. What can be executed comes first among those as good but for a rounding error, of which recursion without
    // a cost may have any number.
    const Worth priority = compounds_.empty() ? better_than(f, options_.tolerance) : f;
    open_.push(static_cast<NodeId>(nodes_.size()), priority, h, static_cast<std::uint32_t>(tasks_.tasks.size()));
    nodes_.push_back({network, parent, step});
}

// A lower bound of what plans of the network are worth: none of its tasks has been executed.
Worth PlanBased::bound(NetworkId network) {
    least_.clear();
    for (NetworkBounds& bounds : bounds_) {
        least_.push_back(bounds[network]);
    }
    Worth bound = std::numeric_limits<Worth>::min();
    for (std::uint32_t stage = 0; stage < valuation_.stages(); ++stage) {
        bound = std::max(bound, valuation_.bound(valuation_.start(), {network, least_}, stage));
    }
    return bound;
}

// Plans are wanted that are worth less.
Worth PlanBased::cutoff() const {
    return solution_ ? better_than(solution_->worth, options_.tolerance) : options_.upper_bound.value_or(kNoWorth);
}

// Look for the best order in which the primitive network can be executed. Where it is worth more than f, which was a
// lower bound then, something else that is open may be better.
std::optional<StopReason> PlanBased::execute(NodeId node) {
    ++statistics_.evaluated;
    std::optional<StopReason> stop;
    auto order = linearisation_.find(nodes_[node].network, stop);
    if (!order) {
        statistics_.dead_ends += stop ? 0 : 1;
        return stop;
    }
    return find_best_order(node, std::move(*order));
}

// The order that was found is the cheapest at the first prices; it is the best one where a label is no more than that.
std::optional<StopReason> PlanBased::find_best_order(NodeId node, Linearisation::Order order) {
    LabelSearch::Way best{order.cost, std::move(order.steps)};
    std::optional<StopReason> stop;
    if (!valuation_.is_total_order()) {
        const std::vector<std::optional<ActionName>> no_names(problem_.action_count());
        LabelSearchOptions options;
        options.upper_bound = cutoff();
        options.tolerance = options_.tolerance;
        LabelStatistics statistics;
        LabelSearch search(problem_, valuation_, no_names, options, progression_, limits_, statistics);
        stop = search.search(nodes_[node].network);
        auto found = search.best();
        if (!found) {
            return stop;
        }
        best = std::move(*found);
    }
    if (best.worth < cutoff()) {
        solution_ = {node, best.worth, std::move(best.steps)};
        statistics_.best = solution_->worth;
        valuation_.set_cutoff(cutoff());
    }
    return stop;
}

LabelSearchResult plan_based_search(const AnalysedProblem& problem, Valuation& valuation,
                                    const PlanBasedOptions& options, Limits& limits, LabelStatistics& statistics) {
    LabelSearchResult result;
    SearchResult found;
    const auto stop = run_within_limits([&]() -> std::optional<StopReason> {
        found = PlanBased(problem, valuation, options, limits, statistics).run();
        return found.stop;
    });
    result.stop = stop;
    result.is_all = !stop && found.status == SearchStatus::Unsolvable && !options.upper_bound;
    result.statistics = statistics;
    if (!result.stop && found.status == SearchStatus::Unsolvable && options.upper_bound) {
        result.statistics.lower_bound = options.upper_bound;
    }
    if (found.cost) {
        result.statistics.found = 1;
        result.worths.push_back(*statistics.best);
        result.plans.push_back(std::move(found));
    }
    return result;
}

void PlanBased::trace(SearchResult& result) {
    std::vector<SearchStep> steps;
    for (NodeId id = solution_->node; nodes_[id].parent != id; id = nodes_[id].parent) {
        steps.push_back(nodes_[id].step);
    }
    std::reverse(steps.begin(), steps.end());
    steps.insert(steps.end(), solution_->order.begin(), solution_->order.end());
    trace_steps(*valuation_.prices().front(), progression_.networks(), steps, limits_, result);
}

}  // namespace relax
