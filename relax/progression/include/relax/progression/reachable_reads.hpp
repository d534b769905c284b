#ifndef RELAX_PROGRESSION_REACHABLE_READS_HPP
#define RELAX_PROGRESSION_REACHABLE_READS_HPP

#include <cstdint>
#include <span>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/rows.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/problem/ground_problem.hpp"
#include "relax/problem/state.hpp"

namespace relax {

// Which facts matter to a state: those that an action reads which is still within reach, where actions delete nothing
// and negative preconditions hold. States forget the others, which then count as false. (A spare wheel at a place to
// which no road leads any more does not matter.)
//
// No plan is lost, none is gained, and each keeps its cost. Let R be the actions within reach of a state s, and t what
// s keeps. R is within reach of t, too, by induction: an action of R needs facts of s, which t keeps since it reads
// them, and facts that actions before it make. No other action is, since t holds no more. So from both states only
// actions of R can ever be executed, and these are applicable in both or in neither, with the same cases and cost
// parts. It holds for the outcomes of chance, which are actions, as well. Nor does a heuristic rise that ignores what
// actions delete: the operators of the others are out of its reach, too.
class ReachableReads {
public:
    ReachableReads(const GroundProblem& problem, Limits& limits);  // throws Stopped

    // As bits by FactId; valid until the next call.
    std::span<const std::uint64_t> of(std::span<const std::uint64_t> state);
    // That a call takes at most: actions and their preconditions.
    std::uint64_t work() const { return work_; }

private:
    void reach(FactId fact);
    void reach(ActionId action);

    const GroundProblem& problem_;
    Rows<ActionId, FactId> readers_;  // those that have the fact as a precondition
    std::vector<std::uint32_t> precondition_counts_;
    std::vector<ActionId> always_;  // those that have none
    std::uint64_t work_ = 0;
    // Of the state looked at.
    std::vector<std::uint32_t> missing_;  // by ActionId: preconditions out of reach
    StateBits reached_;
    std::vector<FactId> pending_;
    StateBits reads_;
};

// States without the facts that no longer matter to them. Where hardly any two become one by that, and looking takes
// long, only some are looked at.
class ReducedStates {
public:
    ReducedStates(const GroundProblem& problem, Limits& limits) : reads_(problem, limits) {}  // throws Stopped

    StateId of(StateId state, StateRegistry& states);
    // What matters to a state, as bits by FactId, whether it was looked at or not: what was forgotten on the way to it
    // does not. Valid until the next call.
    std::span<const std::uint64_t> facts_that_matter(std::span<const std::uint64_t> state) { return reads_.of(state); }

private:
    static constexpr StateId kUnknown{static_cast<std::uint32_t>(-1)};
    static constexpr std::uint64_t kFirst = 256;  // states that are looked at in any case
    static constexpr std::uint64_t kWorth = 16;   // looking at so many states is worth it where one is merged
    // Else looking may take so much for each state that is met, in actions and their preconditions: far less than what
    // is done with a state.
    static constexpr std::uint64_t kWorkPerState = 2000;

    bool is_worth_looking() const {
        return seen_ < kFirst || merged_ * kWorth >= seen_ || seen_ * reads_.work() <= kWorkPerState * met_;
    }

    void make_room(StateId state);

    ReachableReads reads_;
    SegmentedArray<StateId> known_;
    std::uint64_t met_ = 0;     // states ...
    std::uint64_t seen_ = 0;    // ... of which so many were looked at ...
    std::uint64_t merged_ = 0;  // ... and so many became one that another had become
    StateBits kept_;
};

}  // namespace relax

#endif
