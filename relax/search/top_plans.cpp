#include "relax/search/top_plans.hpp"

#include <algorithm>
#include <utility>

#include "relax/analysis/tdg_bound.hpp"
#include "relax/search/cheap_bound.hpp"
#include "relax/search/plan_trace.hpp"

namespace relax {

namespace {

std::uint64_t hash_of(std::uint32_t high, std::uint32_t low) { return mix((std::uint64_t{high} << 32) | low); }

// Between sequences the order of named actions makes a difference: they are not executed at once.
std::vector<bool> free_actions(const PricedProblem& priced, std::span<const std::optional<ActionName>> names,
                               Distinct distinct) {
    std::vector<bool> is_free = priced.free_actions();
    for (std::size_t action = 0; action < names.size(); ++action) {
        is_free[action] = is_free[action] && (distinct == Distinct::Multiset || !names[action]);
    }
    return is_free;
}

// Stubborn sets leave out orders of the same actions.
ProgressionOptions allowed(const TopPlansOptions& options) {
    ProgressionOptions allowed = {options};
    allowed.stubborn_sets = allowed.stubborn_sets && options.distinct == Distinct::Multiset;
    return allowed;
}

}  // namespace

TopPlans::TopPlans(const PricedProblem& priced, std::vector<std::optional<ActionName>> names,
                   const TopPlansOptions& options, Limits& limits, TopPlansStatistics& statistics)
    : priced_(priced),
      problem_(priced.problem),
      names_(std::move(names)),
      options_(options),
      limits_(limits),
      statistics_(statistics),
      progression_(priced.problem, free_actions(priced, names_, options.distinct), allowed(options), limits),
      bounds_(progression_.networks(), priced.task_bounds(limits)),
      heuristic_(options.heuristic->make(priced, limits)) {}

TopPlansResult top_plans(const PricedProblem& priced, std::vector<std::optional<ActionName>> names,
                         const TopPlansOptions& options, Limits& limits, TopPlansStatistics& statistics) {
    TopPlansResult result;
    const auto stop = run_within_limits([&]() -> std::optional<StopReason> {
        result = TopPlans(priced, std::move(names), options, limits, statistics).run();
        return result.stop;
    });
    result.stop = stop;
    return result;
}

TopPlansResult TopPlans::run() {
    TopPlansResult result;
    if (!problem_.solvable) {
        result.is_all = true;
        return result;
    }
    result.stop = run_within_limits([this] { return search(); });
    const Limits::Grace grace(limits_);
    result.is_all =
        !result.stop && ((plans_.size() < options_.count && !has_overflowed_) || (open_.is_empty() && !has_pruned_));
    if (result.is_all) {
        statistics_.lower_bound.reset();
        statistics_.proven = plans_.size();
    } else {
        note_proven(result.stop ? 0 : cutoff());
        statistics_.lower_bound = std::min(*statistics_.lower_bound, cutoff());
    }
    for (const LabelId goal : plans_) {
        SearchResult plan = trace(goal);
        if (!plan.cost) {
            result.stop = result.stop ? result.stop : plan.stop;
            result.is_all = false;
            statistics_.proven = std::min<std::uint64_t>(statistics_.proven, result.plans.size());
            statistics_.lower_bound = std::min(statistics_.lower_bound.value_or(kMostCost), labels_[goal].g);
            break;
        }
        result.plans.push_back(std::move(plan));
    }
    result.statistics = statistics_;
    return result;
}

// Search until no open node leads to a plan that is wanted. Says why it was stopped before that.
std::optional<StopReason> TopPlans::search() {
    const NodeId root = find_node(progression_.initial_state(), progression_.initial_network());
    keep(add_label({0, root, ActionLists::kEmpty, LabelId{0}, {}, false, false}));
    push(LabelId{0});
    while (!open_.is_empty() && open_.top().priority < cutoff()) {
        if (const auto stop = limits_.check()) {
            return stop;
        }
        const OpenList<LabelId>::Entry entry = open_.pop();
        note_proven(entry.priority);
        const Label& label = labels_[entry.id];
        if (!label.is_kept || label.is_expanded || !evaluate(nodes_[label.node])) {
            continue;
        }
        if (priority(label) > entry.priority) {
            has_overflowed_ = has_overflowed_ || priority(label) >= kMostCost;
            push(entry.id);
            continue;
        }
        expand(entry.id);
    }
    return std::nullopt;
}

// Ask the heuristic, if it has not been asked about this node. False if it is a dead end.
bool TopPlans::evaluate(Node& node) {
    if (!node.is_evaluated) {
        NodeView view = progression_.view(node.state, node.network);
        view.tdg_bound = bounds_[node.network];
        const auto h = heuristic_->evaluate(view);
        ++statistics_.evaluated;
        statistics_.dead_ends += h ? 0 : 1;
        statistics_.cuts = heuristic_->rounds();
        node.h = std::max(node.h, h.value_or(kInfinity));
        node.is_evaluated = true;
    }
    return node.h < kInfinity;
}

void TopPlans::expand(LabelId id) {
    labels_[id].is_expanded = true;
    ++statistics_.expanded;
    const Node& node = nodes_[labels_[id].node];
    progression_.expand(node.state, node.network, successors_);
    for (const Successor& successor : successors_) {
        generate(id, successor);
    }
}

void TopPlans::generate(LabelId parent, const Successor& successor) {
    ++statistics_.generated;
    const Cost cost = priced_.cost(successor.action, successor.due_parts);
    const Cost g = add_bounds(labels_[parent].g, cost);
    const NodeId node = find_node(successor.state, successor.network);
    nodes_[node].h = std::max(nodes_[node].h, cheap_bound(options_, *options_.heuristic, bounds_[successor.network],
                                                          nodes_[labels_[parent].node].h, cost));
    if (const Cost f = add_bounds(g, nodes_[node].h); f >= cutoff()) {
        has_pruned_ = has_pruned_ || f < kInfinity;
        has_overflowed_ = has_overflowed_ || f == kMostCost;
        return;
    }
    const ActionListId actions = list_after(parent, successor.action);
    const auto known = find_label(node, actions);
    if (known && labels_[*known].g <= g) {
        return;
    }
    const Label label{g, node, actions, parent, successor.step, known && labels_[*known].is_kept, false};
    const LabelId id = known ? *known : add_label(label);
    labels_[id] = label;
    if (!keep(id)) {
        return;
    }
    if (progression_.networks().is_empty(successor.network)) {
        add_plan(id);
    } else {
        push(id);
    }
}

// Keep the new or improved label among the cheapest of its node, if it is one of them.
bool TopPlans::keep(LabelId id) {
    std::vector<LabelId>& kept = nodes_[labels_[id].node].labels;
    const auto cheaper = [this](LabelId left, LabelId right) { return is_cheaper(left, right); };
    if (labels_[id].is_kept) {
        std::make_heap(kept.begin(), kept.end(), cheaper);
        return true;
    }
    kept.push_back(id);
    labels_[id].is_kept = true;
    std::push_heap(kept.begin(), kept.end(), cheaper);
    if (options_.limits_labels && kept.size() > options_.count) {
        std::pop_heap(kept.begin(), kept.end(), cheaper);
        labels_[kept.back()].is_kept = false;
        kept.pop_back();
        has_pruned_ = true;
    }
    return labels_[id].is_kept;
}

// By g, the older one among equals.
bool TopPlans::is_cheaper(LabelId left, LabelId right) const {
    return labels_[left].g != labels_[right].g ? labels_[left].g < labels_[right].g : left < right;
}

// Take up a new plan, or one that has become cheaper, among those found. A multiset may lead to several final states.
void TopPlans::add_plan(LabelId id) {
    const auto same =
        std::ranges::find_if(plans_, [&](LabelId other) { return labels_[other].actions == labels_[id].actions; });
    if (same != plans_.end()) {
        if (*same != id && labels_[*same].g <= labels_[id].g) {
            return;
        }
        plans_.erase(same);
    }
    plans_.insert(
        std::ranges::upper_bound(plans_, labels_[id].g, {}, [this](LabelId other) { return labels_[other].g; }), id);
    if (plans_.size() > options_.count) {
        plans_.pop_back();
        has_pruned_ = true;
    }
    statistics_.found = plans_.size();
    statistics_.best = labels_[plans_.front()].g;
    note_proven(0);
}

// Every plan that is cheaper than `bound` has been found.
void TopPlans::note_proven(Cost bound) {
    statistics_.lower_bound = std::max(statistics_.lower_bound.value_or(0), bound);
    while (statistics_.proven < plans_.size() && labels_[plans_[statistics_.proven]].g <= *statistics_.lower_bound) {
        ++statistics_.proven;
    }
}

// Open labels with this priority or a higher one lead to no plan that is wanted.
Cost TopPlans::cutoff() const { return plans_.size() < options_.count ? kMostCost : labels_[plans_.back()].g; }

// The list of the actions after a step, which executed one or none.
ActionListId TopPlans::list_after(LabelId label, std::optional<ActionId> action) {
    const ActionListId before = labels_[label].actions;
    if (!action || !names_[*action]) {
        return before;
    }
    const ActionName name = *names_[*action];
    return options_.distinct == Distinct::Sequence ? lists_.append(before, name) : lists_.insert(before, name);
}

NodeId TopPlans::find_node(StateId state, NetworkId network) {
    const auto known = node_table_.find(
        hash_of(state, network), [&](NodeId id) { return nodes_[id].state == state && nodes_[id].network == network; });
    if (known) {
        return *known;
    }
    const auto id = static_cast<NodeId>(nodes_.size());
    nodes_.push_back({state, network, 0, false, {}});
    node_table_.add(hash_of(state, network), id,
                    [this](NodeId other) { return hash_of(nodes_[other].state, nodes_[other].network); });
    return id;
}

std::optional<TopPlans::LabelId> TopPlans::find_label(NodeId node, ActionListId actions) const {
    return label_table_.find(hash_of(node, actions),
                             [&](LabelId id) { return labels_[id].node == node && labels_[id].actions == actions; });
}

// Add a label that is not yet there.
TopPlans::LabelId TopPlans::add_label(const Label& label) {
    const auto id = static_cast<LabelId>(labels_.size());
    labels_.push_back(label);
    label_table_.add(hash_of(label.node, label.actions), id,
                     [this](LabelId other) { return hash_of(labels_[other].node, labels_[other].actions); });
    return id;
}

void TopPlans::push(LabelId id) {
    const Label& label = labels_[id];
    const Node& node = nodes_[label.node];
    open_.push(id, priority(label), node.h, progression_.networks().size(node.network));
}

SearchResult TopPlans::trace(LabelId goal) {
    std::vector<SearchStep> steps;
    for (LabelId id = goal; labels_[id].parent != id; id = labels_[id].parent) {
        steps.push_back(labels_[id].step);
    }
    std::reverse(steps.begin(), steps.end());
    SearchResult result;
    trace_steps(priced_, progression_, steps, limits_, result);
    return result;
}

}  // namespace relax
