#ifndef RELAX_PROGRESSION_STUBBORN_SET_HPP
#define RELAX_PROGRESSION_STUBBORN_SET_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/analysis/task_profiles.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/networks/ordered_tasks.hpp"
#include "relax/networks/task_network.hpp"
#include "relax/problem/state.hpp"

namespace relax {

// Which of a network's unconstrained actions need to be tried next: a set such that no plan loses anything if one of
// it comes first (after Valmari's stubborn sets, 1989), before any other action and before any task is decomposed. The
// rest of the network, compound tasks with all that they may lead to included, as far as it is not ordered after the
// set, must not interfere with an applicable action of the set, nor make a false precondition of another one true.
// Every task has to be executed some time; the first one of the set can then be moved to the front of any plan.
class StubbornSet {
public:
    StubbornSet(const AnalysedProblem& problem, Limits& limits)
        : problem_(problem), limits_(limits), transition_(problem), compounds_(TaskProfile::empty(problem)) {}

    // Find the applicable ones of the smallest such set: where there are none, the node is a dead end. Nothing, where
    // every set has to do with an unconstrained compound task. Valid until the next call. Throws Stopped.
    std::optional<std::span<const Occurrence>> find(const OrderedTasks& network, std::span<const std::uint64_t> state,
                                                    std::span<const Occurrence> unconstrained);

    // How many tasks and words of their order it has looked at so far.
    std::uint64_t work() const { return work_; }

private:
    bool close(const OrderedTasks& network, std::span<const std::uint64_t> state, std::uint32_t seed);
    bool concerns(const TaskProfile& other, std::uint32_t member, std::span<const std::uint64_t> state) const;
    std::optional<std::uint32_t> open_before(const OrderedTasks& network, std::uint32_t task) const;
    void put(std::uint32_t index);

    const AnalysedProblem& problem_;
    Limits& limits_;
    StateTransition transition_;
    // Of the network looked at.
    OrderedTasks successors_;
    std::vector<const TaskProfile*> occurring_;  // by occurrence
    std::vector<std::uint64_t> is_open_;         // a row: the unconstrained actions
    TaskProfile compounds_;                      // what the unconstrained compound tasks read and make, together
    std::vector<std::uint64_t> is_applicable_;   // a row
    // The set being made.
    std::vector<std::uint32_t> members_;
    std::vector<std::uint64_t> is_member_;  // a row
    std::vector<std::uint64_t> is_after_;   // a row: what is ordered after a member
    std::vector<Occurrence> found_;
    std::uint64_t work_ = 0;
};

}  // namespace relax

#endif
