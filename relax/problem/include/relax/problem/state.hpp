#ifndef RELAX_PROBLEM_STATE_HPP
#define RELAX_PROBLEM_STATE_HPP

#include <cstdint>
#include <span>
#include <vector>

#include "relax/base/bits.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/problem/ground_problem.hpp"
#include "relax/problem/literal.hpp"

namespace relax {

using StateId = Id<struct StateTag>;

// Facts of a state as bits.
using StateBits = std::vector<std::uint64_t>;

inline bool holds(std::span<const std::uint64_t> state, FactId fact) { return has_bit(state, fact); }
inline bool holds(std::span<const std::uint64_t> state, Literal literal) {
    return has_bit(state, fact_of(literal)) != is_negated(literal);
}

// Executes actions in states.
class StateTransition {
public:
    explicit StateTransition(const GroundProblem& problem) : problem_(problem) {}

    std::size_t word_count() const { return words_for(problem_.fact_count()); }
    StateBits initial_state() const;
    bool is_applicable(ActionId action, std::span<const std::uint64_t> state) const;
    // Write the state after the action into `next`. What is added wins over what is deleted.
    void apply(ActionId action, std::span<const std::uint64_t> state, std::span<std::uint64_t> next) const;
    // Whether the part of an action's cost is due in the state before the action.
    bool is_due(CostPartId part, std::span<const std::uint64_t> state) const;
    // An action that changes nothing in any state.
    bool has_no_effect(ActionId action) const { return problem_.effects[action].empty(); }

private:
    bool fires(EffectId effect, std::span<const std::uint64_t> state) const;

    const GroundProblem& problem_;
};

// Every state that the search has met, once.
class StateRegistry {
public:
    explicit StateRegistry(std::size_t word_count) : word_count_(word_count) {}

    StateId intern(std::span<const std::uint64_t> state);
    std::span<const std::uint64_t> operator[](StateId id) const { return {starts_[id], word_count_}; }

private:
    std::size_t word_count_;
    RunArena<std::uint64_t> words_;
    SegmentedArray<const std::uint64_t*> starts_;
    IdTable<StateId> table_;
};

}  // namespace relax

#endif
