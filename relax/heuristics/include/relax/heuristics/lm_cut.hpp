#ifndef RELAX_HEURISTICS_LM_CUT_HPP
#define RELAX_HEURISTICS_LM_CUT_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "relax/base/limits.hpp"
#include "relax/heuristics/hmax.hpp"
#include "relax/heuristics/relaxed_task.hpp"

namespace relax {

// The landmark-cut heuristic (Helmert and Domshlak 2009). Each round finds a set of owners (actions, or methods) one of
// which every plan of the relaxed task needs, adds the least cost among them, and takes it off all of them, until the
// goals are free.
//
// A round looks backward from the goal alone: the goal zone are the facts that lead to the most expensive goal for
// free, along supporters, and the cut are the operators that lead into it from a fact outside that the state reaches.
// Facts of the zone cost as much as the goal at least. A cheaper fact is therefore reached without the zone, as every
// fact is by way of cheaper ones; only for more expensive facts must a path be looked for.
class LmCut {
public:
    static constexpr bool kReadsOperators = true;

    LmCut(const RelaxedModel& model, Limits& limits);

    // Returns a lower bound of the cost of any plan of the relaxed task, or nothing where there is none. A limit ends
    // the rounds early, with a lower bound all the same; before the first round it throws Stopped.
    std::optional<Cost> run(const RelaxedTask& task);
    // How many operators have been looked at so far.
    std::uint64_t work() const { return looks_ + hmax_.work(); }
    // How many cuts have been made so far.
    std::uint64_t rounds() const { return rounds_; }

private:
    enum class Zone : std::uint8_t { Unknown, Goal, Reached, Unreached };
    struct Mark {
        std::uint64_t round;
        Zone zone;
    };

    void mark_goal_zone(const RelaxedTask& task);
    Cost take_off_cut();
    void find_cut(const RelaxedTask& task, Cost goal_cost);
    bool is_reached_outside(const RelaxedTask& task, RelaxedFact fact, Cost goal_cost);
    Zone zone(RelaxedFact fact) const { return marks_[fact].round == rounds_ ? marks_[fact].zone : Zone::Unknown; }
    void put_into_goal_zone(RelaxedFact fact);

    const RelaxedModel& model_;
    Limits& limits_;
    HMax hmax_;
    std::vector<Cost> costs_;               // by OwnerId, what is left of them
    std::vector<Mark> marks_;               // by RelaxedFact, as of a round
    std::vector<std::uint64_t> cut_round_;  // by OwnerId: the round in which it was put into the cut
    std::vector<OperatorId> entrances_;     // operators that cost something and lead into the goal zone
    std::vector<OwnerId> cut_;
    std::vector<OwnerId> lowered_;  // owners whose cost differs from the model's
    std::vector<OperatorId> changed_;
    std::vector<RelaxedFact> pending_;
    std::vector<RelaxedFact> seen_;
    std::uint64_t rounds_ = 0;
    std::uint64_t looks_ = 0;
};

}  // namespace relax

#endif
