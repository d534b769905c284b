#ifndef RELAX_PROGRESSION_BRANCHING_HPP
#define RELAX_PROGRESSION_BRANCHING_HPP

#include <cstdint>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// Which of several unconstrained compound tasks to decompose first: the one whose methods lead to the fewest nodes that
// have to be expanded, by statistics of the search so far, as mixed-integer programming learns on which variable to
// branch (pseudo-costs: Benichou et al. 1971). At first it is the task with the fewest methods. Any choice keeps all
// plans.
class Branching {
public:
    explicit Branching(const GroundProblem& problem) : problem_(problem), records_(problem.task_count(), {0, 0}) {}

    // The task has been decomposed by all of its methods that may work.
    void note_decomposed(TaskId task) { ++records_[task].decomposed; }
    // A node that the method led to is expanded.
    void note_survivor(MethodId method) { ++records_[problem_.method_task[method]].survivors; }

    // How many of the nodes that the task's methods lead to will be expanded, as far as one can tell.
    double expect_survivors(TaskId task) const {
        const Record& record = records_[task];
        const auto methods = static_cast<double>(problem_.methods_of(task).size());
        return (methods + static_cast<double>(record.survivors)) / (1 + static_cast<double>(record.decomposed));
    }

private:
    struct Record {
        std::uint64_t decomposed;
        std::uint64_t survivors;
    };

    const GroundProblem& problem_;
    std::vector<Record> records_;  // by TaskId
};

}  // namespace relax

#endif
