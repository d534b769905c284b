#include "relax/lm_cut.hpp"

#include <algorithm>

namespace relax {

LmCut::LmCut(const RelaxedModel& model, Limits& limits)
    : model_(model),
      limits_(limits),
      hmax_(model),
      costs_(model.owner_cost),
      zone_round_(model.fact_count(), 0),
      zone_(model.fact_count(), Zone::Neither),
      cut_round_(model.owner_cost.size(), 0) {}

std::optional<Cost> LmCut::run(const RelaxedTask& task) {
    for (const OwnerId owner : lowered_) {
        costs_[owner] = model_.owner_cost[owner];
    }
    lowered_.clear();
    const auto first = hmax_.run(task, costs_);
    if (!first) {
        return std::nullopt;
    }
    Cost total = 0;
    Cost left = *first;
    while (left > 0 && !limits_.check()) {
        ++rounds_;
        mark_goal_zone(hmax_.dearest_goal());
        find_cut(task);
        Cost least = HMax::kInfinite;
        for (const OwnerId owner : cut_) {
            least = std::min(least, costs_[owner]);
        }
        total += least;
        changed_.clear();
        for (const OwnerId owner : cut_) {
            costs_[owner] -= least;
            lowered_.push_back(owner);
            const auto row = model_.owner_operators[owner];
            changed_.insert(changed_.end(), row.begin(), row.end());
        }
        left = hmax_.lower(changed_, costs_);
    }
    return total;
}

// The goal zone: the dearest goal, and all supporters of free operators that achieve a fact of the zone.
void LmCut::mark_goal_zone(RelaxedFact goal) {
    put_into_goal_zone(goal);
    while (!pending_.empty()) {
        const RelaxedFact fact = pending_.back();
        pending_.pop_back();
        const auto achievers = model_.achievers[fact];
        looks_ += achievers.size();
        for (const OperatorId op : achievers) {
            if (costs_[model_.owner[op]] == 0 && hmax_.is_reached(op)) {
                put_into_goal_zone(hmax_.supporter(op));
            }
        }
    }
}

// The cut: owners of operators that lead, along supporters, from what the state reaches before the goal zone into it.
void LmCut::find_cut(const RelaxedTask& task) {
    cut_.clear();
    const auto put_before = [this](RelaxedFact fact) {
        if (zone_round_[fact] != rounds_) {
            zone_round_[fact] = rounds_;
            zone_[fact] = Zone::Before;
            pending_.push_back(fact);
        }
    };
    for (const RelaxedFact fact : task.facts()) {
        put_before(fact);
    }
    while (!pending_.empty()) {
        const RelaxedFact fact = pending_.back();
        pending_.pop_back();
        const auto readers = model_.precondition_of[fact];
        looks_ += readers.size();
        for (const OperatorId op : readers) {
            if (!hmax_.is_reached(op) || hmax_.supporter(op) != fact) {
                continue;
            }
            const auto row = model_.adds[op];
            const bool enters = std::any_of(row.begin(), row.end(), [this](RelaxedFact made) {
                return zone_round_[made] == rounds_ && zone_[made] == Zone::Goal;
            });
            if (enters) {
                put_into_cut(model_.owner[op]);
            } else {
                std::for_each(row.begin(), row.end(), put_before);
            }
        }
    }
}

void LmCut::put_into_goal_zone(RelaxedFact fact) {
    if (zone_round_[fact] != rounds_) {
        zone_round_[fact] = rounds_;
        zone_[fact] = Zone::Goal;
        pending_.push_back(fact);
    }
}

void LmCut::put_into_cut(OwnerId owner) {
    if (cut_round_[owner] != rounds_) {
        cut_round_[owner] = rounds_;
        cut_.push_back(owner);
    }
}

}  // namespace relax
