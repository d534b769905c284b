#include "relax/heuristics/lm_cut.hpp"

#include <algorithm>

#include "relax/base/cost.hpp"

namespace relax {

LmCut::LmCut(const RelaxedModel& model, Limits& limits)
    : model_(model),
      limits_(limits),
      hmax_(model, limits),
      costs_(model.owner_cost),
      marks_(model.fact_count(), {0, Zone::Unknown}),
      cut_round_(model.owner_cost.size(), 0) {}

std::optional<Cost> LmCut::run(const RelaxedTask& task) {
    for (const OwnerId owner : lowered_) {
        costs_[owner] = model_.owner_cost[owner];
    }
    lowered_.clear();
    if (task.fact_count() > marks_.size()) {
        marks_.resize(task.fact_count(), {0, Zone::Unknown});
    }
    const auto first = hmax_.run(task, costs_);
    if (!first) {
        return std::nullopt;
    }
    Cost total = 0;
    try {
        for (Cost left = *first; left > 0;) {
            limits_.stop_if_reached();
            ++rounds_;
            mark_goal_zone(task);
            find_cut(task, left);
            total = add_bounds(total, take_off_cut());
            left = hmax_.lower(task, changed_, costs_);
        }
    } catch (const Stopped&) {
        return total;  // the cuts so far are a bound all the same
    }
    return total;
}

// Take the least cost among the cut's owners off all of them, and return it.
Cost LmCut::take_off_cut() {
    Cost least = kInfinity;
    for (const OwnerId owner : cut_) {
        least = std::min(least, costs_[owner]);
    }
    changed_.clear();
    for (const OwnerId owner : cut_) {
        costs_[owner] -= least;
        lowered_.push_back(owner);
        const auto row = model_.owner_operators[owner];
        changed_.insert(changed_.end(), row.begin(), row.end());
    }
    return least;
}

// The goal zone: the most expensive goal, and all supporters of operators without a cost that achieve a fact of it.
void LmCut::mark_goal_zone(const RelaxedTask& task) {
    entrances_.clear();
    pending_.clear();
    put_into_goal_zone(hmax_.most_expensive_goal());
    while (!pending_.empty()) {
        const RelaxedFact fact = pending_.back();
        pending_.pop_back();
        limits_.stop_if_reached();
        task.for_each_achiever(fact, [&](OperatorId op) {
            ++looks_;
            if (!hmax_.is_reached(op)) {
                return;
            }
            if (costs_[task.owner(op)] == 0) {
                put_into_goal_zone(hmax_.supporter(op));
            } else {
                entrances_.push_back(op);
            }
        });
    }
}

// The cut: owners of operators that lead into the goal zone from a fact that the state reaches outside it.
void LmCut::find_cut(const RelaxedTask& task, Cost goal_cost) {
    cut_.clear();
    for (const OperatorId op : entrances_) {
        const OwnerId owner = task.owner(op);
        if (cut_round_[owner] != rounds_ && is_reached_outside(task, hmax_.supporter(op), goal_cost)) {
            cut_round_[owner] = rounds_;
            cut_.push_back(owner);
        }
    }
}

// Whether the state reaches the fact along supporters outside the goal zone.
bool LmCut::is_reached_outside(const RelaxedTask& task, RelaxedFact fact, Cost goal_cost) {
    if (zone(fact) != Zone::Unknown) {
        return zone(fact) == Zone::Reached;
    }
    // Until a path is found, the facts looked at count as unreached; if none is found, they are.
    bool is_reached = hmax_.cost(fact) < goal_cost;
    marks_[fact] = {rounds_, Zone::Unreached};
    pending_.assign(1, fact);
    seen_.assign(1, fact);
    while (!is_reached && !pending_.empty()) {
        const RelaxedFact next = pending_.back();
        pending_.pop_back();
        limits_.stop_if_reached();
        task.for_each_achiever(next, [&](OperatorId op) {
            ++looks_;
            if (is_reached || !hmax_.is_reached(op)) {
                return;
            }
            const RelaxedFact supporter = hmax_.supporter(op);
            if (zone(supporter) == Zone::Reached || hmax_.cost(supporter) < goal_cost) {
                is_reached = true;
            } else if (zone(supporter) == Zone::Unknown) {
                marks_[supporter] = {rounds_, Zone::Unreached};
                pending_.push_back(supporter);
                seen_.push_back(supporter);
            }
        });
    }
    if (is_reached) {
        for (const RelaxedFact looked_at : seen_) {
            marks_[looked_at].zone = Zone::Unknown;
        }
        marks_[fact].zone = Zone::Reached;
    }
    return is_reached;
}

void LmCut::put_into_goal_zone(RelaxedFact fact) {
    if (zone(fact) != Zone::Goal) {
        marks_[fact] = {rounds_, Zone::Goal};
        pending_.push_back(fact);
    }
}

}  // namespace relax
