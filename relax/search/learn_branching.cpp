#include "relax/search/learn_branching.hpp"

namespace relax {

void learn_branching(Branching& branching, const GroundProblem& problem, const SearchSpace& nodes, NodeId expanded,
                     std::span<const Successor> successors) {
    if (successors.size() > 1 && successors.front().step.method) {
        branching.note_decomposed(problem.method_task[*successors.front().step.method]);
    }
    while (nodes[expanded].is_forced) {
        expanded = nodes[expanded].parent;
    }
    if (const auto method = nodes[expanded].step().method) {
        branching.note_survivor(*method);
    }
}

}  // namespace relax
