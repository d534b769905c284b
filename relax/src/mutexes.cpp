#include "relax/mutexes.hpp"

#include <algorithm>
#include <bit>

#include "relax/state.hpp"

namespace relax {

namespace {

constexpr std::size_t kMostWords = 2'000'000;    // of memory
constexpr std::uint64_t kMostWork = 20'000'000;  // in words looked at

}  // namespace

Mutexes::Mutexes(const GroundProblem& problem, Limits& limits)
    : problem_(problem),
      words_((problem.fact_count() + 63) / 64),
      changed_(problem.fact_count(), 0),
      reached_(words_, 0),
      beside_(words_),
      after_(words_) {
    const std::size_t words = problem.fact_count() * words_;
    if (words > kMostWords) {
        return;
    }
    together_.assign(words, 0);
    Row initial(words_, 0);
    for (const FactId fact : problem.initial_state) {
        set_fact(initial, fact);
    }
    for (const FactId fact : problem.initial_state) {
        limits.stop_if_reached();
        put_together(fact, initial);
    }
    std::vector<std::uint32_t> executed(problem.action_count(), 0);  // by ActionId: when
    std::uint64_t work = 0;
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (ActionId action = 0; action < problem.action_count(); ++action) {
            limits.stop_if_reached();
            if (!has_news(action, executed[action])) {
                continue;
            }
            has_changed = true;
            executed[action] = ++tick_;
            execute(action);
            work += words_ * (2 + problem.preconditions[action].size());
        }
        if (work > kMostWork) {
            together_.clear();
            return;
        }
    }
}

// Whether its preconditions may hold with more facts than when it was executed last.
bool Mutexes::has_news(ActionId action, std::uint32_t since) const {
    const auto needed = problem_.preconditions[action];
    if (needed.empty()) {
        return reached_tick_ >= since;
    }
    return std::ranges::any_of(needed, [&](FactId fact) { return changed_[fact] >= since; });
}

// What may hold after the action, pair by pair. Conditions of effects are not looked at: such an effect may add its
// facts, and deletes nothing for certain. Negative preconditions are not looked at either.
void Mutexes::execute(ActionId action) {
    beside_ = reached_;
    for (const FactId needed : problem_.preconditions[action]) {
        for (std::size_t word = 0; word < words_; ++word) {
            beside_[word] &= row(needed)[word];
        }
    }
    for (const FactId needed : problem_.preconditions[action]) {
        if (!contains(beside_, needed)) {
            return;
        }
    }
    after_ = beside_;
    const EffectId begin = problem_.effect_begin[action];
    const EffectId end = problem_.effect_begin[action + 1];
    for (EffectId effect = begin; effect < end; ++effect) {
        if (problem_.effect_conditions[effect].empty() && problem_.effect_negative_conditions[effect].empty()) {
            for (const FactId fact : problem_.effect_deletes[effect]) {
                clear_fact(after_, fact);
            }
        }
    }
    for (EffectId effect = begin; effect < end; ++effect) {
        for (const FactId fact : problem_.effect_adds[effect]) {
            set_fact(after_, fact);
        }
    }
    for (EffectId effect = begin; effect < end; ++effect) {
        for (const FactId fact : problem_.effect_adds[effect]) {
            put_together(fact, after_);
        }
    }
}

void Mutexes::put_together(FactId fact, const Row& others) {
    if (!contains(reached_, fact)) {
        set_fact(reached_, fact);
        reached_tick_ = tick_;
    }
    for (std::size_t word = 0; word < words_; ++word) {
        std::uint64_t fresh = others[word] & ~together_[fact * words_ + word];
        together_[fact * words_ + word] |= fresh;
        if (fresh != 0) {
            changed_[fact] = tick_;
        }
        for (; fresh != 0; fresh &= fresh - 1) {
            const std::size_t other = word * 64 + static_cast<std::size_t>(std::countr_zero(fresh));
            set_fact(std::span(together_).subspan(other * words_, words_), fact);
            changed_[other] = tick_;
        }
    }
}

}  // namespace relax
