#ifndef RELAX_PROGRESSION_ENDING_HPP
#define RELAX_PROGRESSION_ENDING_HPP

#include <cstdint>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/base/limits.hpp"
#include "relax/networks/macro_actions.hpp"
#include "relax/networks/ordered_tasks.hpp"
#include "relax/problem/ground_problem.hpp"

namespace relax {

// How a network in partial order can end: its last actions in every order that they may have, found backward.
//
// The last action that is executed belongs to a task that nothing is ordered after: one of the network's last tasks.
// If all of these are actions, it is one of them; without it, the same holds of the rest. So every plan ends in a
// sequence of actions that this backward search meets, up to the first place where a compound task may come. Where each
// such sequence is impossible (MacroActions: no state that can be reached lets it be executed), there is no plan,
// whatever the compound tasks become.
class Ending {
public:
    Ending(const AnalysedProblem& problem, Limits& limits) : problem_(problem), macros_(problem, limits) {}

    // False: the network has no plan. True says nothing.
    bool is_possible(const OrderedTasks& network);
    // Whether it should be asked about the next network: rarely, where it has hardly ever told anything.
    bool is_worth_asking();

    // How many tasks and words of their order it has looked at so far.
    std::uint64_t work() const { return work_; }

private:
    bool can_end(const OrderedTasks& network, MacroId last);

    const GroundProblem& problem_;
    MacroActions macros_;
    std::vector<bool> is_left_;              // by occurrence: not yet among the last actions
    std::vector<std::uint64_t> is_before_;   // a row: occurrences with others after them that are left
    std::vector<std::uint32_t> candidates_;  // of all levels: occurrences that may be next, backward
    std::uint32_t steps_ = 0;                // tried so far
    std::uint64_t networks_ = 0;
    std::uint64_t asked_ = 0;
    std::uint64_t impossible_ = 0;
    std::uint64_t work_ = 0;
};

}  // namespace relax

#endif
