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

// A stubborn set (Valmari 1989): unconstrained actions S of a network such that expanding only the applicable members
// of S keeps a plan of every cost. Let R be the tasks outside S that are not ordered after a member of S; a compound
// task stands for every action that it may lead to.
//
// (1) Where a member `a` of S is applicable: no action of R makes false what `a` reads, `a` makes false nothing that an
//     action of R reads, and the two make no contradictory facts.
// (2) Where `a` is not applicable: one of its preconditions is false, and no action of R makes it true.
//
// Proof. Every plan executes all members of S, since no task of a network is optional. Take a plan and the member b of
// S that comes first in it. What is executed before b comes from R: it is not of S, and it is not ordered after a
// member of S, since none has been executed. By (2) b is applicable now. By (1) it commutes with everything before it;
// moving it to the front changes no later state, no case of an action (conditions of effects and of costs count as
// read, with their negations), and so no cost. Nor does it matter for decomposing, which does not depend on the state.
// If no member of S is applicable, the same argument shows that there is no plan.
//
// The set is closed by adding what violates (1) or (2): an action of R that is unconstrained itself, or else an
// unconstrained action before it, which takes it out of R.
//
// For policies (PolicyProgression) chance tasks are actions, and nothing of R is uncertain, either, unless it is asked
// for sets without that condition.
class StubbornSet {
public:
    // `uncertain`: for policies, by TaskId; it must live longer.
    StubbornSet(const AnalysedProblem& problem, Limits& limits, const std::vector<bool>* uncertain = nullptr)
        : problem_(problem),
          limits_(limits),
          uncertain_(uncertain),
          transition_(problem),
          compounds_(TaskProfile::empty(problem)) {}

    // Find the applicable members of the smallest such set: where there are none, the node is a dead end. Nothing,
    // where every set would have to contain a compound task. Valid until the next call. Throws Stopped.
    //
    // `is_certain`: whether what is uncertain is kept out of R.
    std::optional<std::span<const Occurrence>> find(const OrderedTasks& network, std::span<const std::uint64_t> state,
                                                    std::span<const Occurrence> unconstrained, bool is_certain = true);

    // How many tasks and words of their order it has looked at so far.
    std::uint64_t work() const { return work_; }

private:
    bool is_action(TaskId task) const {
        return problem_.is_primitive(task) || (uncertain_ != nullptr && problem_.is_chance(task));
    }
    bool is_kept_out(TaskId task) const { return uncertain_ != nullptr && is_certain_ && (*uncertain_)[task]; }
    bool close(const OrderedTasks& network, std::span<const std::uint64_t> state, std::uint32_t seed);
    bool concerns(const TaskProfile& other, std::uint32_t member, std::span<const std::uint64_t> state) const;
    std::optional<std::uint32_t> open_before(const OrderedTasks& network, std::uint32_t task) const;
    void put(std::uint32_t index);

    const AnalysedProblem& problem_;
    Limits& limits_;
    const std::vector<bool>* uncertain_;  // nothing for plans
    StateTransition transition_;
    // Of the network looked at.
    OrderedTasks successors_;
    std::vector<const TaskProfile*> occurring_;  // by occurrence
    std::vector<std::uint64_t> is_open_;         // a row: the unconstrained actions
    TaskProfile compounds_;                      // what the unconstrained compound tasks read and make, together
    bool are_compounds_kept_out_ = false;        // whether one of them has to be
    bool is_certain_ = true;
    std::vector<std::uint64_t> is_applicable_;  // a row
    // The set being made.
    std::vector<std::uint32_t> members_;
    std::vector<std::uint64_t> is_member_;  // a row
    std::vector<std::uint64_t> is_after_;   // a row: what is ordered after a member
    std::vector<Occurrence> found_;
    std::uint64_t work_ = 0;
};

}  // namespace relax

#endif
