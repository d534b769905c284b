#ifndef RELAX_MUTEXES_HPP
#define RELAX_MUTEXES_HPP

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relax/ground_problem.hpp"
#include "relax/ids.hpp"
#include "relax/limits.hpp"

namespace relax {

// Pairs of facts that never hold together, whatever actions are executed in whatever order: those that h^2 (Haslum and
// Geffner 2000) cannot reach.
class Mutexes {
public:
    // On large problems nothing is found, since it would take too long. Throws Stopped.
    Mutexes(const GroundProblem& problem, Limits& limits);

    bool are_mutex(FactId one, FactId other) const {
        return !together_.empty() && !contains(row(one), other) && one != other;
    }

private:
    using Row = std::vector<std::uint64_t>;

    static bool contains(std::span<const std::uint64_t> row, FactId fact) {
        return (row[fact / 64] >> (fact % 64) & 1U) != 0;
    }
    std::span<const std::uint64_t> row(FactId fact) const {
        return std::span(together_).subspan(fact * words_, words_);
    }
    bool has_news(ActionId action, std::uint32_t since) const;
    void execute(ActionId action);
    void put_together(FactId fact, const Row& others);

    const GroundProblem& problem_;
    std::size_t words_;
    std::vector<std::uint64_t> together_;  // by FactId: the facts that it may hold with, itself included
    std::vector<std::uint32_t> changed_;   // by FactId: when its row changed last, counted in executions of actions
    std::uint32_t reached_tick_ = 0;       // when a fact was reached for the first time
    std::uint32_t tick_ = 1;
    Row reached_;
    Row beside_;
    Row after_;
};

}  // namespace relax

#endif
