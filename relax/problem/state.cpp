#include "relax/problem/state.hpp"

#include <algorithm>
#include <cassert>

namespace relax {

namespace {

// All facts of the first list hold, and none of the second.
bool meets(std::span<const std::uint64_t> state, std::span<const FactId> needed, std::span<const FactId> forbidden) {
    const auto is_true = [state](FactId fact) { return holds(state, fact); };
    return std::all_of(needed.begin(), needed.end(), is_true) &&
           std::none_of(forbidden.begin(), forbidden.end(), is_true);
}

}  // namespace

StateBits StateTransition::initial_state() const {
    StateBits state(word_count(), 0);
    for (const FactId fact : problem_.initial_state) {
        set_bit(state, fact);
    }
    return state;
}

bool StateTransition::is_applicable(ActionId action, std::span<const std::uint64_t> state) const {
    assert(state.size() == word_count());
    return meets(state, problem_.preconditions[action], problem_.negative_preconditions[action]);
}

void StateTransition::apply(ActionId action, std::span<const std::uint64_t> state,
                            std::span<std::uint64_t> next) const {
    assert(is_applicable(action, state));
    assert(next.size() == state.size() && (next.empty() || next.data() != state.data()));
    std::copy(state.begin(), state.end(), next.begin());
    for (const EffectId effect : problem_.effects[action]) {
        if (fires(effect, state)) {
            for (const FactId fact : problem_.effect_deletes[effect]) {
                clear_bit(next, fact);
            }
        }
    }
    for (const EffectId effect : problem_.effects[action]) {
        if (fires(effect, state)) {
            for (const FactId fact : problem_.effect_adds[effect]) {
                set_bit(next, fact);
            }
        }
    }
}

bool StateTransition::is_due(CostPartId part, std::span<const std::uint64_t> state) const {
    return std::ranges::any_of(problem_.cost_alternatives[part], [&](AlternativeId alternative) {
        return meets(state, problem_.cost_conditions[alternative], problem_.cost_negative_conditions[alternative]);
    });
}

bool StateTransition::fires(EffectId effect, std::span<const std::uint64_t> state) const {
    return meets(state, problem_.effect_conditions[effect], problem_.effect_negative_conditions[effect]);
}

StateId StateRegistry::intern(std::span<const std::uint64_t> state) {
    assert(state.size() == word_count_);
    const std::uint64_t hash = hash_values(state);
    const auto known =
        table_.find(hash, [&](StateId id) { return std::equal(state.begin(), state.end(), (*this)[id].begin()); });
    if (known) {
        return *known;
    }
    const auto id = static_cast<StateId>(starts_.size());
    const auto run = words_.allocate(word_count_);
    std::copy(state.begin(), state.end(), run.begin());
    starts_.push_back(run.data());
    table_.add(hash, id);
    return id;
}

}  // namespace relax
