#include "relax/search/top_plans.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "relax/analysis/cost_shifting.hpp"
#include "relax/analysis/tdg_bound.hpp"
#include "relax/search/plan_trace.hpp"

namespace relax {

namespace {

constexpr Cost kDeadEnd = kNoDecomposition;

std::uint64_t hash_of(std::uint32_t high, std::uint32_t low) { return mix((std::uint64_t{high} << 32) | low); }

std::vector<bool> without_label(std::span<const std::optional<ActionLabel>> labels) {
    std::vector<bool> result;
    for (const auto& label : labels) {
        result.push_back(!label);
    }
    return result;
}

// Stubborn sets leave out orders of the same actions.
ProgressionOptions allowed(const TopPlansOptions& options) {
    ProgressionOptions allowed = options.search;
    allowed.use_stubborn_sets = allowed.use_stubborn_sets && options.distinct == Distinct::Multiset;
    return allowed;
}

}  // namespace

TopPlans::TopPlans(const GroundProblem& problem, Prices prices, std::vector<std::optional<ActionLabel>> labels,
                   const TopPlansOptions& options, Limits& limits, TopPlansStatistics& statistics)
    : problem_(problem),
      prices_(std::move(prices)),
      labels_(std::move(labels)),
      options_(options),
      limits_(limits),
      statistics_(statistics),
      progression_(problem, prices_, tdg_bound(problem, shift_costs(problem, prices_, limits).actions, limits),
                   allowed(options), limits),
      heuristic_(make_heuristic(options.search.heuristic, problem, prices_, limits)) {
    if (options_.distinct == Distinct::Sequence) {
        progression_.hurry_only(without_label(labels_));
    }
}

TopPlansResult top_plans(const GroundProblem& problem, Prices prices, std::vector<std::optional<ActionLabel>> labels,
                         const TopPlansOptions& options, Limits& limits, TopPlansStatistics& statistics) {
    TopPlansResult stopped_early;
    try {
        return TopPlans(problem, std::move(prices), std::move(labels), options, limits, statistics).run();
    } catch (const Stopped& stopped) {
        stopped_early.stop = stopped.reason;
    } catch (const std::bad_alloc&) {
        stopped_early.stop = StopReason::MemoryLimit;
    }
    return stopped_early;
}

TopPlansResult TopPlans::run() {
    TopPlansResult result;
    if (!problem_.solvable) {
        result.is_all = true;
        return result;
    }
    try {
        result.stop = search();
    } catch (const Stopped& stopped) {
        result.stop = stopped.reason;
    } catch (const std::bad_alloc&) {
        result.stop = StopReason::MemoryLimit;
    }
    const Limits::Suspension suspension(limits_);
    result.is_all =
        !result.stop && ((plans_.size() < options_.count && !is_cut_) || (open_.is_empty() && !leaves_out_));
    if (result.is_all) {
        statistics_.lower_bound.reset();
        statistics_.proven = plans_.size();
    } else {
        note_proven(result.stop ? 0 : enough());
        statistics_.lower_bound = std::min(*statistics_.lower_bound, enough());
    }
    for (const WayId goal : plans_) {
        result.plans.push_back(trace(goal));
    }
    result.statistics = statistics_;
    return result;
}

// Search until no open node leads to a plan that is wanted. Says why it was stopped before that.
std::optional<StopReason> TopPlans::search() {
    const PairId root = find_pair(progression_.initial_state(), progression_.initial_network());
    keep(add_way({0, root, ActionLists::kEmpty, 0, {}, false, false}));
    push(0);
    while (!open_.is_empty() && open_.top().priority < enough()) {
        if (const auto stop = limits_.check()) {
            return stop;
        }
        const OpenList::Entry entry = open_.pop();
        note_proven(entry.priority);
        const Way& way = ways_[entry.node];
        if (!way.is_kept || way.is_expanded || !evaluate(pairs_[way.pair])) {
            continue;
        }
        if (priority(way) > entry.priority) {
            is_cut_ = is_cut_ || priority(way) >= kMostCost;
            push(entry.node);
            continue;
        }
        expand(entry.node);
    }
    return std::nullopt;
}

// Ask the heuristic, if it has not been asked about this pair. False if it is a dead end.
bool TopPlans::evaluate(Pair& pair) {
    if (!pair.is_evaluated) {
        const auto h = heuristic_->evaluate(progression_.view(pair.state, pair.network));
        ++statistics_.evaluated;
        statistics_.dead_ends += h ? 0 : 1;
        statistics_.cuts = heuristic_->rounds();
        pair.h = std::max(pair.h, h.value_or(kDeadEnd));
        pair.is_evaluated = true;
    }
    return pair.h < kDeadEnd;
}

void TopPlans::expand(WayId id) {
    ways_[id].is_expanded = true;
    ++statistics_.expanded;
    const Pair& pair = pairs_[ways_[id].pair];
    tasks_.clear();
    progression_.networks().tasks(pair.network, tasks_);
    progression_.expand(pair.state, pair.network, successors_);
    for (const Successor& successor : successors_) {
        generate(id, successor);
    }
}

void TopPlans::generate(WayId parent, const Successor& successor) {
    ++statistics_.generated;
    const Cost g = add_bounds(ways_[parent].g, successor.cost);
    const PairId pair = find_pair(successor.state, successor.network);
    pairs_[pair].h = std::max(pairs_[pair].h, cheap_bound(pairs_[ways_[parent].pair], successor));
    if (const Cost f = add_bounds(g, pairs_[pair].h); f >= enough()) {
        leaves_out_ = leaves_out_ || f < kDeadEnd;
        is_cut_ = is_cut_ || f == kMostCost;
        return;
    }
    const ActionListId actions = list_after(parent, successor.step);
    const auto known = find_way(pair, actions);
    if (known && ways_[*known].g <= g) {
        return;
    }
    const Way way{g, pair, actions, parent, successor.step, known && ways_[*known].is_kept, false};
    const WayId id = known ? *known : add_way(way);
    ways_[id] = way;
    if (!keep(id)) {
        return;
    }
    if (progression_.networks().is_empty(successor.network)) {
        add_plan(id);
    } else {
        push(id);
    }
}

// Keep the new or improved way among the cheapest ones to its pair, if it is one of them.
bool TopPlans::keep(WayId id) {
    std::vector<WayId>& kept = pairs_[ways_[id].pair].ways;
    const auto cheaper = [this](WayId left, WayId right) { return is_cheaper(left, right); };
    if (ways_[id].is_kept) {
        std::make_heap(kept.begin(), kept.end(), cheaper);
        return true;
    }
    kept.push_back(id);
    ways_[id].is_kept = true;
    std::push_heap(kept.begin(), kept.end(), cheaper);
    if (options_.limits_ways && kept.size() > options_.count) {
        std::pop_heap(kept.begin(), kept.end(), cheaper);
        ways_[kept.back()].is_kept = false;
        kept.pop_back();
        leaves_out_ = true;
    }
    return ways_[id].is_kept;
}

// By g, the older one among equals.
bool TopPlans::is_cheaper(WayId left, WayId right) const {
    return ways_[left].g != ways_[right].g ? ways_[left].g < ways_[right].g : left < right;
}

// Take up a new plan, or one that has become cheaper, among those found. A multiset may lead to several final states.
void TopPlans::add_plan(WayId id) {
    const auto same =
        std::ranges::find_if(plans_, [&](WayId other) { return ways_[other].actions == ways_[id].actions; });
    if (same != plans_.end()) {
        if (*same != id && ways_[*same].g <= ways_[id].g) {
            return;
        }
        plans_.erase(same);
    }
    plans_.insert(std::ranges::upper_bound(plans_, ways_[id].g, {}, [this](WayId other) { return ways_[other].g; }),
                  id);
    if (plans_.size() > options_.count) {
        plans_.pop_back();
        leaves_out_ = true;
    }
    statistics_.found = plans_.size();
    statistics_.best = ways_[plans_.front()].g;
    note_proven(0);
}

// Every plan that is cheaper than `bound` has been found.
void TopPlans::note_proven(Cost bound) {
    statistics_.lower_bound = std::max(statistics_.lower_bound.value_or(0), bound);
    while (statistics_.proven < plans_.size() && ways_[plans_[statistics_.proven]].g <= *statistics_.lower_bound) {
        ++statistics_.proven;
    }
}

// The priority from which nothing that is open is worth a look.
Cost TopPlans::enough() const { return plans_.size() < options_.count ? kMostCost : ways_[plans_.back()].g; }

// The list of the actions after a step. `tasks_` are those of the way's network.
ActionListId TopPlans::list_after(WayId way, const SearchStep& step) {
    const ActionListId before = ways_[way].actions;
    if (step.method || !labels_[tasks_[step.occurrence]]) {
        return before;
    }
    const ActionLabel label = *labels_[tasks_[step.occurrence]];
    return options_.distinct == Distinct::Sequence ? lists_.append(before, label) : lists_.insert(before, label);
}

Cost TopPlans::cheap_bound(const Pair& parent, const Successor& successor) {
    Cost bound = 0;
    if (options_.search.use_tdg_bound && options_.search.heuristic != HeuristicKind::Blind) {
        bound = progression_.networks().bound(successor.network);
    }
    if (options_.search.inherit_h) {
        bound = std::max(bound, parent.h - successor.cost);
    }
    return bound;
}

TopPlans::PairId TopPlans::find_pair(StateId state, NetworkId network) {
    const auto known = pair_table_.find(
        hash_of(state, network), [&](PairId id) { return pairs_[id].state == state && pairs_[id].network == network; });
    if (known) {
        return *known;
    }
    const auto id = static_cast<PairId>(pairs_.size());
    pairs_.push_back({state, network, 0, false, {}});
    pair_table_.add(hash_of(state, network), id,
                    [this](PairId other) { return hash_of(pairs_[other].state, pairs_[other].network); });
    return id;
}

std::optional<TopPlans::WayId> TopPlans::find_way(PairId pair, ActionListId actions) const {
    return way_table_.find(hash_of(pair, actions),
                           [&](WayId id) { return ways_[id].pair == pair && ways_[id].actions == actions; });
}

// Add a way that is not yet there.
TopPlans::WayId TopPlans::add_way(const Way& way) {
    const auto id = static_cast<WayId>(ways_.size());
    ways_.push_back(way);
    way_table_.add(hash_of(way.pair, way.actions), id,
                   [this](WayId other) { return hash_of(ways_[other].pair, ways_[other].actions); });
    return id;
}

void TopPlans::push(WayId id) {
    const Way& way = ways_[id];
    const Pair& pair = pairs_[way.pair];
    open_.push(id, priority(way), pair.h, progression_.networks().size(pair.network));
}

SearchResult TopPlans::trace(WayId goal) {
    std::vector<SearchStep> steps;
    for (WayId id = goal; ways_[id].parent != id; id = ways_[id].parent) {
        steps.push_back(ways_[id].step);
    }
    std::reverse(steps.begin(), steps.end());
    SearchResult result;
    trace_steps(problem_, prices_, progression_, steps, result);
    return result;
}

}  // namespace relax
