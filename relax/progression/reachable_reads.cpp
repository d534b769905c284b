#include "relax/progression/reachable_reads.hpp"

#include <algorithm>

#include "relax/analysis/task_reads.hpp"
#include "relax/base/bits.hpp"

namespace relax {

ReachableReads::ReachableReads(const GroundProblem& problem, Limits& limits)
    : problem_(problem),
      readers_(invert(problem.preconditions, problem.fact_count(), limits)),
      missing_(problem.action_count()),
      reached_(words_for(problem.fact_count())),
      reads_(words_for(problem.fact_count())) {
    for (const ActionId action : problem.actions()) {
        precondition_counts_.push_back(static_cast<std::uint32_t>(problem.preconditions[action].size()));
        work_ += 1 + precondition_counts_.back();
        if (precondition_counts_.back() == 0) {
            always_.push_back(action);
        }
    }
}

std::span<const std::uint64_t> ReachableReads::of(std::span<const std::uint64_t> state) {
    std::ranges::copy(precondition_counts_, missing_.begin());
    std::ranges::fill(reached_, 0);
    std::ranges::fill(reads_, 0);
    for (const ActionId action : always_) {
        reach(action);
    }
    for_each_bit(state, [this](std::size_t fact) { reach(FactId(static_cast<std::uint32_t>(fact))); });
    while (!pending_.empty()) {
        const FactId fact = pending_.back();
        pending_.pop_back();
        for (const ActionId action : readers_[fact]) {
            if (--missing_[action] == 0) {
                reach(action);
            }
        }
    }
    return reads_;
}

void ReachableReads::reach(FactId fact) {
    if (!has_bit(reached_, fact)) {
        set_bit(reached_, fact);
        pending_.push_back(fact);
    }
}

void ReachableReads::reach(ActionId action) {
    add_reads(problem_, action, reads_);
    for (const EffectId effect : problem_.effects[action]) {
        for (const FactId fact : problem_.effect_adds[effect]) {
            reach(fact);
        }
    }
}

StateId ReducedStates::of(StateId state, StateRegistry& states) {
    make_room(state);
    if (known_[state] != kUnknown) {
        return known_[state];
    }
    ++met_;
    StateId reduced = state;
    if (is_worth_looking()) {
        const auto facts = states[state];
        kept_.assign(facts.begin(), facts.end());
        keep_common(kept_, reads_.of(facts));
        reduced = states.intern(kept_);
        ++seen_;
        merged_ += reduced < known_.size() && reduced != state ? 1 : 0;  // another state had become this one
        make_room(reduced);
        known_[reduced] = reduced;
    }
    return known_[state] = reduced;
}

void ReducedStates::make_room(StateId state) {
    while (known_.size() <= state) {
        known_.push_back(kUnknown);
    }
}

}  // namespace relax
