#ifndef RELAX_ANALYSIS_TASK_READS_HPP
#define RELAX_ANALYSIS_TASK_READS_HPP

#include <cstdint>
#include <span>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// Add the facts that an action reads, as a precondition of either sign or as a condition of an effect or of a part of
// the cost, to bits by FactId.
void add_reads(const GroundProblem& problem, ActionId action, std::span<std::uint64_t> mask);

// Which facts a task's actions read, whichever of its decompositions is chosen. The same for all tasks that lead to one
// another.
class TaskReads {
public:
    TaskReads(const GroundProblem& problem, Limits& limits);  // throws Stopped

    // As bits by FactId.
    std::span<const std::uint64_t> operator[](TaskId task) const {
        return std::span(masks_).subspan(component_[task] * words_, words_);
    }

private:
    void find_components(const GroundProblem& problem, Limits& limits);
    void close_component(const GroundProblem& problem, std::span<const TaskId> members, Limits& limits);
    std::span<std::uint64_t> add_component();

    std::size_t words_;  // of a mask
    // By TaskId: its strongly connected component in the task decomposition graph; by component: what is read below it.
    std::vector<std::uint32_t> component_;
    std::vector<std::uint64_t> masks_;
    std::uint32_t component_count_ = 0;
};

}  // namespace relax

#endif
