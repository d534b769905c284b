#ifndef RELAX_ANALYSIS_MUTEXES_HPP
#define RELAX_ANALYSIS_MUTEXES_HPP

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/ground_problem.hpp"
#include "relax/problem/literal.hpp"

namespace relax {

// Pairs of facts, and of facts and negated facts, that never hold together, whatever actions are executed in whatever
// order: those that h^2 (Haslum and Geffner 2000) cannot reach. Of negated facts only those are known that some action
// or effect reads.
//
// A pair is reachable if it holds initially, or if an action may be executed (each two of its preconditions are a
// reachable pair) that makes both, or makes one and leaves the other, which is reachable with each of the
// preconditions. By induction on the length of sequences of actions, each two literals that hold in a state that can be
// reached are a reachable pair. So literals of any other pair never hold together, after whatever sequence of actions;
// the sequences that a network allows are some of these.
class Mutexes {
public:
    // On large problems nothing is found, since it would take too long. Throws Stopped.
    Mutexes(const GroundProblem& problem, Limits& limits);

    bool are_mutex(Literal one, Literal other) const;
    // Whether the action may be executed in some state; true where that is not known.
    bool is_possible(ActionId action) const { return together_.empty() || is_possible_[action]; }

private:
    using Row = std::vector<std::uint64_t>;
    using Index = std::uint32_t;  // of a fact, or of a negated fact that is read: these come after the facts
    static constexpr Index kUnread = std::numeric_limits<Index>::max();

    Index index(Literal literal) const {
        return is_negated(literal) ? negated_[fact_of(literal)] : Index{fact_of(literal)};
    }
    std::span<const std::uint64_t> row(Index index) const {
        return std::span(together_).subspan(index * words_, words_);
    }
    void number_negated(const GroundProblem& problem);
    void start(const GroundProblem& problem);
    bool has_news(std::span<const Index> needed, std::uint32_t since) const;
    bool execute(const GroundProblem& problem, ActionId action, std::span<const Index> needed);
    void affect(const GroundProblem& problem, EffectId effect);
    void put_together(Index index);

    std::vector<Index> negated_;     // by FactId
    std::vector<FactId> fact_of_;    // by index
    std::size_t words_ = 0;          // of a row
    Row together_;                   // by index: the literals that it may hold with, itself included
    std::vector<bool> is_possible_;  // by ActionId
    // While it is being made.
    std::vector<std::uint32_t> changed_;  // by index: when its row changed last, counted in executions of actions
    std::uint32_t reached_tick_ = 0;      // when a literal was reached for the first time
    std::uint32_t tick_ = 1;
    Row reached_;
    Row beside_;   // what may hold before the action that is executed ...
    Row after_;    // ... and after it
    Row certain_;  // facts that it adds for certain
    std::vector<Index> made_;
};

}  // namespace relax

#endif
