#include "relax/analysis/mutexes.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

#include "relax/problem/state.hpp"

namespace relax {

namespace {

constexpr std::size_t kMostWords = 2'000'000;    // of memory
constexpr std::uint64_t kMostWork = 40'000'000;  // in words looked at

}  // namespace

Mutexes::Mutexes(const GroundProblem& problem, Limits& limits) {
    number_negated(problem);
    words_ = words_for(fact_of_.size());
    if (fact_of_.size() * words_ > kMostWords) {
        return;
    }
    start(problem);
    Rows<Index> needed;
    for (const ActionId action : problem.actions()) {
        limits.stop_if_reached();
        for (const FactId fact : problem.preconditions[action]) {
            needed.push(fact);
        }
        for (const FactId fact : problem.negative_preconditions[action]) {
            needed.push(negated_[fact]);
        }
        needed.finish_row();
    }
    std::vector<std::uint32_t> executed(problem.action_count(), 0);  // by ActionId: when
    std::uint64_t work = 0;
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (const ActionId action : problem.actions()) {
            limits.stop_if_reached();
            if (!has_news(needed[action], executed[action])) {
                continue;
            }
            has_changed = true;
            executed[action] = ++tick_;
            is_possible_[action] = execute(problem, action, needed[action]);
            work += words_ * (2 + needed[action].size() + made_.size());
        }
        if (work > kMostWork) {
            together_.clear();
            return;
        }
    }
}

bool Mutexes::are_mutex(Literal one, Literal other) const {
    if (one == negation(other)) {
        return true;
    }
    if (together_.empty() || one == other || index(one) == kUnread || index(other) == kUnread) {
        return false;
    }
    return !has_bit(row(index(one)), index(other));
}

void Mutexes::number_negated(const GroundProblem& problem) {
    negated_.assign(problem.fact_count(), kUnread);
    for (const FactId fact : problem.facts()) {
        fact_of_.push_back(fact);
    }
    const auto read = [this](std::span<const FactId> facts) {
        for (const FactId fact : facts) {
            if (negated_[fact] == kUnread) {
                negated_[fact] = static_cast<Index>(fact_of_.size());
                fact_of_.push_back(fact);
            }
        }
    };
    for (const ActionId action : problem.actions()) {
        read(problem.negative_preconditions[action]);
        for (const EffectId effect : problem.effects[action]) {
            read(problem.effect_negative_conditions[effect]);
        }
    }
}

// Everything that holds initially holds together.
void Mutexes::start(const GroundProblem& problem) {
    together_.assign(fact_of_.size() * words_, 0);
    changed_.assign(fact_of_.size(), 0);
    is_possible_.assign(problem.action_count(), false);
    for (Row* row : {&reached_, &beside_, &after_, &certain_}) {
        row->assign(words_, 0);
    }
    Row state(words_, 0);
    for (const FactId fact : problem.initial_state) {
        set_bit(state, fact);
    }
    for (Index index = 0; index < fact_of_.size(); ++index) {
        const bool is_negated = index >= negated_.size();
        if (has_bit(state, fact_of_[index]) != is_negated) {
            set_bit(after_, index);
            made_.push_back(index);
        }
    }
    for (const Index index : made_) {
        put_together(index);
    }
}

// Whether the preconditions may hold with more literals than when the action was executed last.
bool Mutexes::has_news(std::span<const Index> needed, std::uint32_t since) const {
    if (needed.empty()) {
        return reached_tick_ >= since;
    }
    return std::ranges::any_of(needed, [&](Index index) { return changed_[index] >= since; });
}

// Put together what may hold after the action. False if it cannot be executed.
bool Mutexes::execute(const GroundProblem& problem, ActionId action, std::span<const Index> needed) {
    made_.clear();
    beside_ = reached_;
    for (const Index index : needed) {
        keep_common(beside_, row(index));
    }
    if (!std::ranges::all_of(needed, [this](Index index) { return has_bit(beside_, index); })) {
        return false;
    }
    after_ = beside_;
    for (const EffectId effect : problem.effects[action]) {
        if (problem.is_unconditional(effect)) {
            for (const FactId fact : problem.effect_adds[effect]) {
                set_bit(certain_, fact);
            }
        }
    }
    // What is certain first: it takes away what held before.
    for (const bool is_certain : {true, false}) {
        for (const EffectId effect : problem.effects[action]) {
            if (problem.is_unconditional(effect) == is_certain) {
                affect(problem, effect);
            }
        }
    }
    for (const EffectId effect : problem.effects[action]) {
        for (const FactId fact : problem.effect_adds[effect]) {
            clear_bit(certain_, fact);
        }
    }
    for (const Index index : made_) {
        put_together(index);
    }
    return true;
}

// Change what may hold after the action by an effect: one without a condition makes its literals true for certain and
// their negations false, one with a condition that may hold does so or does not. Adding wins over deleting.
void Mutexes::affect(const GroundProblem& problem, EffectId effect) {
    const bool is_certain = problem.is_unconditional(effect);
    const auto is_out = [&](Index index) { return !has_bit(beside_, index); };
    if (std::ranges::any_of(problem.effect_conditions[effect], is_out) ||
        std::ranges::any_of(problem.effect_negative_conditions[effect],
                            [&](FactId fact) { return is_out(negated_[fact]); })) {
        return;
    }
    const auto make = [&](Index made, Index lost) {
        if (is_certain && lost != kUnread) {
            clear_bit(after_, lost);
        }
        if (made != kUnread) {
            set_bit(after_, made);
            made_.push_back(made);
        }
    };
    for (const FactId fact : problem.effect_deletes[effect]) {
        if (!has_bit(certain_, fact)) {
            make(negated_[fact], fact);
        }
    }
    for (const FactId fact : problem.effect_adds[effect]) {
        make(fact, negated_[fact]);
    }
}

// The literal may hold with all that may hold after the action, but for its own negation.
void Mutexes::put_together(Index index) {
    assert(index < fact_of_.size() && has_bit(after_, index));
    if (!has_bit(reached_, index)) {
        set_bit(reached_, index);
        reached_tick_ = tick_;
    }
    const FactId fact = fact_of_[index];
    const Index opposite = index == fact ? negated_[fact] : fact;
    for (std::size_t word = 0; word < words_; ++word) {
        std::uint64_t fresh = after_[word] & ~together_[index * words_ + word];
        if (opposite != kUnread && opposite / 64 == word) {
            fresh &= ~(std::uint64_t{1} << (opposite % 64));
        }
        together_[index * words_ + word] |= fresh;
        if (fresh != 0) {
            changed_[index] = tick_;
        }
        for (; fresh != 0; fresh &= fresh - 1) {
            const std::size_t other = word * 64 + static_cast<std::size_t>(std::countr_zero(fresh));
            set_bit(std::span(together_).subspan(other * words_, words_), index);
            changed_[other] = tick_;
        }
    }
}

}  // namespace relax
