#include "relax/analysis/subtask_sequences.hpp"

#include <algorithm>
#include <functional>
#include <vector>

namespace relax {

namespace {

std::vector<std::uint32_t> sequence_of(const GroundProblem& problem, MethodId method) {
    const auto ordering = problem.method_ordering[method];  // sorted pairs
    const std::size_t count = problem.method_subtasks[method].size();
    std::vector<std::uint32_t> before(count, 0);
    for (const auto& [earlier, later] : ordering) {
        ++before[later];
    }
    // Of those that may come next, the first in the domain: a heap.
    std::vector<std::uint32_t> open;
    for (std::uint32_t subtask = 0; subtask < count; ++subtask) {
        if (before[subtask] == 0) {
            open.push_back(subtask);
        }
    }
    std::vector<std::uint32_t> sequence;
    while (!open.empty()) {
        std::ranges::pop_heap(open, std::greater<>());
        const std::uint32_t next = open.back();
        open.pop_back();
        sequence.push_back(next);
        for (const auto& [earlier, later] :
             std::ranges::equal_range(ordering, next, {}, [](const auto& pair) { return pair.first; })) {
            if (--before[later] == 0) {
                open.push_back(later);
                std::ranges::push_heap(open, std::greater<>());
            }
        }
    }
    return sequence;
}

}  // namespace

Rows<std::uint32_t> subtask_sequences(const GroundProblem& problem, Limits& limits) {
    Rows<std::uint32_t> sequences;
    for (const MethodId method : problem.methods()) {
        limits.stop_if_reached();
        sequences.add_row(sequence_of(problem, method));
    }
    return sequences;
}

}  // namespace relax
