#ifndef RELAX_SEARCH_SEARCH_RESULT_HPP
#define RELAX_SEARCH_SEARCH_RESULT_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"

namespace relax {

// GaveUp: neither a plan nor a proof, since a search used up the effort it was given.
enum class SearchStatus : std::uint8_t { Optimal, Solved, Unsolvable, GaveUp, TimeLimit, MemoryLimit, Interrupted };

// How a search without a plan ends that was stopped.
constexpr SearchStatus status_of(StopReason reason) {
    switch (reason) {
        case StopReason::TimeLimit:
            return SearchStatus::TimeLimit;
        case StopReason::MemoryLimit:
            return SearchStatus::MemoryLimit;
        case StopReason::Interrupted:
            break;
    }
    return SearchStatus::Interrupted;
}

struct SearchStatistics {
    std::uint64_t expanded = 0;
    std::uint64_t generated = 0;
    std::uint64_t evaluated = 0;
    std::uint64_t dead_ends = 0;
    std::uint64_t cuts = 0;           // landmark cuts of the heuristics
    std::optional<Cost> lower_bound;  // proven so far
    std::optional<Cost> best;         // cost of the best plan so far
};

// A task of the plan's decomposition tree.
struct DecompositionNode {
    TaskId task;
    std::optional<MethodId> method;       // of a compound task
    std::optional<std::uint32_t> parent;  // index of a node; none for the initial task
    std::uint32_t subtask = 0;            // which of the parent's method's subtasks it is
};

struct SearchResult {
    SearchStatus status = SearchStatus::Unsolvable;
    std::optional<StopReason> stop;  // what ended the search before it was done, with or without a plan
    SearchStatistics statistics;
    // If a plan was found: its cost, the tree, and the leaves in the order of their execution.
    std::optional<Cost> cost;
    std::vector<DecompositionNode> decomposition;  // parents before children
    std::vector<std::uint32_t> plan;
    std::vector<CostPartId> due_parts;           // of the actions' costs, in the order in which they were due
    std::vector<std::uint32_t> due_part_counts;  // by leaf in `plan`: how many of them are its own
};

}  // namespace relax

#endif
