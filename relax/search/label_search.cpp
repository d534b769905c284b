#include "relax/search/label_search.hpp"

#include <algorithm>
#include <utility>

#include "relax/search/plan_trace.hpp"

namespace relax {

namespace {

// In operators that a heuristic looks at; by time, roughly.
constexpr std::uint64_t kWorkOfALabel = 200;
constexpr std::uint64_t kWorkOfAModel = 100;  // for each action and method

// By ActionId: actions that certainly cost nothing may be executed at once; between sequences, where order makes a
// difference, those without a name.
std::vector<bool> free_actions(const Valuation& valuation, std::span<const std::optional<ActionName>> names,
                               const LabelSearchOptions& options) {
    std::vector<bool> is_free = valuation.free_actions();
    for (std::size_t action = 0; action < names.size(); ++action) {
        is_free[action] = is_free[action] && (!options.tells_sequences() || !names[action]);
    }
    return is_free;
}

// Stubborn sets leave out orders of the same actions.
ProgressionOptions allowed(const LabelSearchOptions& options) {
    ProgressionOptions allowed = {options};
    allowed.stubborn_sets = allowed.stubborn_sets && !options.tells_sequences();
    return allowed;
}

}  // namespace

LabelSearch::LabelSearch(const AnalysedProblem& problem, Valuation& valuation,
                         std::span<const std::optional<ActionName>> names, const LabelSearchOptions& options,
                         Progression& progression, Limits& limits, LabelStatistics& statistics)
    : problem_(problem),
      valuation_(valuation),
      names_(names),
      options_(options),
      limits_(limits),
      statistics_(statistics),
      progression_(progression),
      labels_(valuation, options.count, options.limits_labels),
      edges_(valuation, options_, progression, labels_, limits),
      cutoff_(std::min(valuation.most(), options.upper_bound.value_or(kNoWorth))) {
    valuation_.set_cutoff(cutoff_);
}

LabelSearchResult label_search(const AnalysedProblem& problem, Valuation& valuation,
                               std::span<const std::optional<ActionName>> names, const LabelSearchOptions& options,
                               Limits& limits, LabelStatistics& statistics) {
    LabelSearchResult result;
    const auto stop = run_within_limits([&]() -> std::optional<StopReason> {
        Progression progression(problem, free_actions(valuation, names, options), allowed(options), limits);
        if (problem.solvable) {  // else there are no tasks
            valuation.begin(progression.networks(), limits);
        }
        result = LabelSearch(problem, valuation, names, options, progression, limits, statistics).run();
        return result.stop;
    });
    result.stop = stop;
    return result;
}

LabelSearchResult LabelSearch::run() {
    LabelSearchResult result;
    if (!problem_.solvable) {
        result.is_all = true;
        return result;
    }
    result.stop = run_within_limits([this] { return search(progression_.initial_network()); });
    const Limits::Grace grace(limits_);
    const bool is_complete =
        plans_.size() < options_.count ? !has_left_out_ : open_.is_empty() && !has_pruned_ && !labels_.has_pruned();
    result.is_all = !result.stop && is_complete && (plans_.empty() || !leaves_out_orders());
    if (result.is_all) {
        statistics_.lower_bound.reset();
        statistics_.proven = plans_.size();
    } else if (!result.stop) {
        note_proven(is_complete ? labels_[plans_.back()].bound : cutoff_);
    }
    for (const LabelId goal : plans_) {
        SearchResult plan;
        trace_steps(*valuation_.prices().front(), progression_.networks(), steps_to(goal), limits_, plan);
        if (!plan.cost) {
            result.stop = result.stop ? result.stop : plan.stop;
            result.is_all = false;
            statistics_.proven = std::min<std::size_t>(statistics_.proven, result.plans.size());
            const Worth worth = labels_[goal].bound;
            statistics_.lower_bound = std::min(statistics_.lower_bound.value_or(worth), worth);
            break;
        }
        result.plans.push_back(std::move(plan));
        result.worths.push_back(labels_[goal].bound);
    }
    result.statistics = statistics_;
    return result;
}

// Whether plans may be left out for one that has the same actions in another order, and costs the same.
bool LabelSearch::leaves_out_orders() {
    return options_.distinct == Distinct::Sequence && !options_.tells_sequences() &&
           !progression_.networks().are_totally_ordered();
}

// Search until no open label leads to a plan that is wanted. Says why it was stopped before that.
std::optional<StopReason> LabelSearch::search(NetworkId from) {
    const NodeId root = edges_.node_at(progression_.initial_state(), from);
    const ValueId start = valuation_.start();
    const bool is_plan = progression_.networks().is_empty(from);
    const Worth bound = is_plan ? valuation_.worth(start) : valuation_.bound(start, labels_.to_come(root), 0);
    if (bound != kNoWorth) {
        note_proven(bound);
    }
    if (!is_wanted(bound)) {
        return std::nullopt;
    }
    const LabelId first = *labels_.add({root, start, ActionLists::kEmpty, LabelId{0}, nullptr, bound, 0, true, false});
    if (is_plan) {
        add_plan(first);
        return std::nullopt;
    }
    push(first);
    while (!open_.is_empty() && open_.top().priority < cutoff_) {
        if (const auto stop = limits_.check()) {
            return stop;
        }
        const OpenList<LabelId>::Entry entry = open_.pop();
        note_proven(entry.priority);
        if (labels_[entry.id].is_kept && keeps_bound(entry.id)) {
            expand(entry.id);
        }
    }
    return std::nullopt;
}

// Raise the label's bound by what is known of its node, or can be found out. Returns whether it stays as it is;
// otherwise the label goes back into the open list, unless there is no need.
bool LabelSearch::keeps_bound(LabelId id) {
    Label& label = labels_[id];
    LabelSpace::Node& node = labels_.node(label.node);
    const Worth before = label.bound;
    for (;;) {
        label.bound = std::max(before, valuation_.bound(label.value, labels_.to_come(label.node), label.stage));
        if (label.bound > before) {
            if (is_wanted(label.bound)) {
                push(id);
            }
            return false;
        }
        if (node.asked < heuristics_.size() || asks_from_now_on()) {
            ask(node);
        } else if (label.stage + 1 < valuation_.stages()) {
            ++label.stage;
        } else {
            return true;
        }
    }
}

// Heuristics are made when the search has taken as long as that takes, or so: many a problem is solved by then.
bool LabelSearch::asks_from_now_on() {
    const std::uint64_t model = options_.heuristic->has_model ? problem_.action_count() + problem_.method_count() : 0;
    if (!heuristics_.empty() || work() < kWorkOfAModel * model * valuation_.asked()) {
        return false;
    }
    for (const PricedProblem* const priced : valuation_.prices().first(valuation_.asked())) {
        heuristics_.emplace_back(options_.heuristic->make(*priced, limits_), !options_.selective);
    }
    return true;
}

// Ask the heuristic at the next prices about the node, if it is worth it. What is a dead end at some prices is one.
void LabelSearch::ask(LabelSpace::Node& node) {
    const std::size_t price = node.asked++;
    SelectiveHeuristic& heuristic = heuristics_[price];
    if (!heuristic.is_worth_asking()) {
        return;
    }
    NodeView view = progression_.view(node.state, node.network);
    view.tdg_bound = edges_.bound(price, node.network);
    const std::uint64_t cuts_before = heuristic->rounds();
    const auto h = heuristic->evaluate(view);
    ++statistics_.evaluated;
    statistics_.cuts += heuristic->rounds() - cuts_before;
    heuristic.note_answer(!h || *h > node.least[price], work() / std::max<std::uint64_t>(1, statistics_.expanded));
    if (!h) {
        ++statistics_.dead_ends;
        std::ranges::fill(node.least, kInfinity);
        node.asked = static_cast<std::uint32_t>(heuristics_.size());
        return;
    }
    node.least[price] = std::max(node.least[price], *h);
}

// Of the search itself, in operators that a heuristic looks at.
std::uint64_t LabelSearch::work() const { return statistics_.generated * kWorkOfALabel + progression_.work(); }

void LabelSearch::expand(LabelId id) {
    labels_[id].is_expanded = true;
    ++statistics_.expanded;
    const NodeId node = labels_[id].node;
    if (!labels_.node(node).is_expanded) {
        edges_.find(node);
    }
    for (const Edge& edge : labels_.node(node).edges) {
        inherit(node, edge);
        generate(id, edge);
    }
}

// A plan from the parent that goes on with the edge costs what the edge costs, and what the next node is completed for.
void LabelSearch::inherit(NodeId parent, const Edge& edge) {
    if (!options_.inherit_h) {
        return;
    }
    const std::span<const Cost> from = labels_.node(parent).least;
    const std::span<Cost> to = labels_.node(edge.to).least;
    for (std::size_t price = 0; price < from.size(); ++price) {
        to[price] = std::max(to[price], from[price] - edge.costs[price]);
    }
}

void LabelSearch::generate(LabelId parent, const Edge& edge) {
    ++statistics_.generated;
    const Label& from = labels_[parent];
    ValueId value = from.value;
    ActionListId actions = from.actions;
    for (const Execution& execution : edge.executions) {
        value = valuation_.extend(value, execution.action, execution.due_parts);
        actions = list_after(actions, execution.action);
    }
    const bool is_plan = progression_.networks().is_empty(labels_.node(edge.to).network);
    const Worth bound = is_plan ? valuation_.worth(value) : valuation_.bound(value, labels_.to_come(edge.to), 0);
    // Of a plan it is the worth itself: its parent's bound, a sum in another order, may be off by a rounding error.
    const Worth known = is_plan ? bound : std::max(bound, from.bound);
    if (!is_wanted(known)) {
        return;
    }
    const auto id = labels_.add({edge.to, value, actions, parent, &edge, known, 0, true, false});
    if (!id) {
        return;
    }
    if (is_plan) {
        add_plan(*id);
    } else {
        push(*id);
    }
}

// Whether plans of this worth are wanted; notes where there may be some that are not.
bool LabelSearch::is_wanted(Worth bound) {
    if (bound < cutoff_) {
        return true;
    }
    if (bound != kNoWorth) {
        has_pruned_ = true;
        has_left_out_ = has_left_out_ || plans_.size() < options_.count;
    }
    return false;
}

// Take up a new plan, or one that has become better, among those found. A multiset may lead to several final states.
void LabelSearch::add_plan(LabelId id) {
    const Worth worth = labels_[id].bound;
    const auto same =
        std::ranges::find_if(plans_, [&](LabelId other) { return labels_[other].actions == labels_[id].actions; });
    if (same != plans_.end()) {
        has_pruned_ = has_pruned_ || options_.count == 1;
        if (labels_[*same].bound <= worth) {
            return;
        }
        plans_.erase(same);
    }
    plans_.insert(std::ranges::upper_bound(plans_, worth, {}, [this](LabelId other) { return labels_[other].bound; }),
                  id);
    if (plans_.size() > options_.count) {
        plans_.pop_back();
        has_pruned_ = true;
    }
    statistics_.found = plans_.size();
    statistics_.best = labels_[plans_.front()].bound;
    if (plans_.size() == options_.count) {
        cutoff_ = std::min(cutoff_, better_than(labels_[plans_.back()].bound, options_.tolerance));
        valuation_.set_cutoff(cutoff_);
    }
    count_proven();
}

// Every plan that is worth less than `bound` has been found.
void LabelSearch::note_proven(Worth bound) {
    statistics_.lower_bound = std::max(statistics_.lower_bound.value_or(bound), bound);
    count_proven();
}

void LabelSearch::count_proven() {
    while (statistics_.lower_bound && statistics_.proven < plans_.size() &&
           labels_[plans_[statistics_.proven]].bound <= *statistics_.lower_bound) {
        ++statistics_.proven;
    }
}

// The list of the actions after one more. All lists are one where any plan will do.
ActionListId LabelSearch::list_after(ActionListId before, ActionId action) {
    if (options_.count == 1 || !names_[action]) {
        return before;
    }
    const ActionName name = *names_[action];
    return options_.tells_sequences() ? lists_.append(before, name) : lists_.insert(before, name);
}

void LabelSearch::push(LabelId id) {
    const Label& label = labels_[id];
    const Cost tie_break = valuation_.tie_break(label.value, labels_.to_come(label.node));
    open_.push(id, label.bound, tie_break, progression_.networks().size(labels_.node(label.node).network));
}

std::vector<SearchStep> LabelSearch::steps_to(LabelId goal) const {
    std::vector<SearchStep> steps;
    for (LabelId id = goal; labels_[id].edge != nullptr; id = labels_[id].parent) {
        steps.insert(steps.end(), labels_[id].edge->steps.rbegin(), labels_[id].edge->steps.rend());
    }
    std::reverse(steps.begin(), steps.end());
    return steps;
}

std::optional<LabelSearch::Way> LabelSearch::best() const {
    if (plans_.empty()) {
        return std::nullopt;
    }
    return Way{labels_[plans_.front()].bound, steps_to(plans_.front())};
}

}  // namespace relax
