#ifndef RELAX_BINDINGS_NODE_CONTENTS_HPP
#define RELAX_BINDINGS_NODE_CONTENTS_HPP

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "relax/base/bits.hpp"
#include "relax/base/ids.hpp"
#include "relax/networks/ordered_tasks.hpp"
#include "relax/problem/ground_problem.hpp"
#include "relax/progression/policy_progression.hpp"

using OrderedPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// The facts whose bits are set.
inline std::vector<relax::FactId> facts_in(std::span<const std::uint64_t> row) {
    std::vector<relax::FactId> facts;
    relax::for_each_bit(row, [&](std::size_t fact) { facts.emplace_back(fact); });
    return facts;
}

// Pairs of indices into the tasks, the earlier first; transitively closed.
inline OrderedPairs ordered_pairs(const relax::OrderedTasks& ordered) {
    OrderedPairs pairs;
    for (std::uint32_t later = 0; later < ordered.tasks.size(); ++later) {
        relax::for_each_bit(ordered.row(later), [&](std::size_t earlier) {
            pairs.emplace_back(static_cast<std::uint32_t>(earlier), later);
        });
    }
    return pairs;
}

// Throws where what is said of the costs of a problem does not fit it.
inline void check_entries(const relax::GroundProblem& problem, const std::vector<bool>& free_actions,
                          const relax::SeenCosts& seen) {
    if (free_actions.size() != problem.action_count() ||
        (!seen.actions.empty() && seen.actions.size() != problem.action_count()) ||
        (!seen.parts.empty() && seen.parts.size() != problem.cost_part_count())) {
        throw std::invalid_argument("there must be one entry for each action and for each cost part");
    }
}

#endif
