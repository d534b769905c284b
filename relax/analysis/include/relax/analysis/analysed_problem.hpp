#ifndef RELAX_ANALYSIS_ANALYSED_PROBLEM_HPP
#define RELAX_ANALYSIS_ANALYSED_PROBLEM_HPP

#include <memory>
#include <utility>

#include "relax/analysis/mutexes.hpp"
#include "relax/analysis/subtask_sequences.hpp"
#include "relax/analysis/task_profiles.hpp"
#include "relax/analysis/task_reads.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/on_demand.hpp"
#include "relax/base/rows.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// A ground problem, and what is found out about it whatever its actions cost: each thing when it is first asked for,
// for all searches, also of several threads. All of them throw Stopped.
class AnalysedProblem : public GroundProblem {
public:
    explicit AnalysedProblem(GroundProblem problem, std::unique_ptr<const Mutexes> mutexes = nullptr)
        : GroundProblem(std::move(problem)), profiles_(*this), mutexes_(std::move(mutexes)) {}

    const TaskProfile& profile(TaskId task, Limits& limits) const { return profiles_.of(task, limits); }
    const Mutexes& mutexes(Limits& limits) const {
        return mutexes_.get([&] { return Mutexes(*this, limits); });
    }
    const TaskReads& task_reads(Limits& limits) const {
        return task_reads_.get([&] { return TaskReads(*this, limits); });
    }
    // By MethodId: see `subtask_sequences`.
    const Rows<std::uint32_t>& sequences(Limits& limits) const {
        return sequences_.get([&] { return subtask_sequences(*this, limits); });
    }

private:
    TaskProfiles profiles_;
    OnDemand<Mutexes> mutexes_;
    OnDemand<TaskReads> task_reads_;
    OnDemand<Rows<std::uint32_t>> sequences_;
};

}  // namespace relax

#endif
