#ifndef RELAX_STUBBORN_SET_HPP
#define RELAX_STUBBORN_SET_HPP

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relax/canonical_order.hpp"
#include "relax/ground_problem.hpp"
#include "relax/ids.hpp"
#include "relax/state.hpp"
#include "relax/task_network.hpp"
#include "relax/task_profiles.hpp"

namespace relax {

// Which of a network's unconstrained actions need to be tried next: a set such that no plan loses anything if one of
// it comes first (after Valmari's stubborn sets, 1989). The rest of the network, as far as it is not ordered after the
// set, must not interfere with an applicable action of the set, nor make a false precondition of another one true.
// Every task has to be executed some time; the first one of the set can then be moved to the front of any plan.
class StubbornSet {
public:
    explicit StubbornSet(const GroundProblem& problem) : profiles_(problem), transition_(problem) {}

    // Keep of `unconstrained`, which must all be actions, the applicable ones of a small such set. Where nothing is
    // left, the node is a dead end.
    void reduce(const OrderedTasks& network, std::span<const std::uint64_t> state,
                std::vector<Occurrence>& unconstrained);

private:
    void close(const OrderedTasks& network, std::span<const std::uint64_t> state, std::uint32_t seed);
    bool concerns(const TaskProfile& other, std::uint32_t member, std::span<const std::uint64_t> state) const;
    void put(std::uint32_t index);

    TaskProfiles profiles_;
    StateTransition transition_;
    // Of the network looked at.
    OrderedTasks successors_;
    std::vector<const TaskProfile*> occurring_;  // by occurrence
    std::vector<std::uint64_t> is_open_;         // a row: the unconstrained ones
    std::vector<std::uint64_t> is_applicable_;   // a row
    // The set being made.
    std::vector<std::uint32_t> members_;
    std::vector<std::uint64_t> is_member_;  // a row
    std::vector<std::uint64_t> is_after_;   // a row: what is ordered after a member
};

}  // namespace relax

#endif
