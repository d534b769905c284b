#ifndef RELAX_HEURISTICS_LM_CUT_HPP
#define RELAX_HEURISTICS_LM_CUT_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "relax/base/limits.hpp"
#include "relax/heuristics/hmax.hpp"
#include "relax/heuristics/relaxed_task.hpp"

namespace relax {

// The landmark-cut heuristic (Helmert and Domshlak 2009). Each round finds a cut, a set of owners (actions, methods or
// cost parts) one of which every plan of the relaxed task uses, adds the least cost among them to the estimate, and
// subtracts it from all of them, until the goals cost nothing.
//
// Admissible: a plan of the relaxed task uses an owner of each cut. Charge each cut's amount to one that it uses. What
// an owner is charged in all is at most its cost, from which each amount was subtracted when its cut was made; and the
// plan pays an owner's cost once at least, however many of its operators it uses. So the sum of the amounts is at most
// what the plan costs.
//
// A round looks at the graph with an edge for each operator from its supporter (the most expensive precondition) to
// what it adds. The goal zone are the facts from which the most expensive goal is reached by operators without a cost.
// The cut are the owners of the operators that lead into the zone from a fact that the state reaches outside it. It is
// a landmark: follow a plan's operators backward from that goal, from each to its supporter. The path comes from a fact
// of the state, which costs nothing and is outside the zone, and where it enters the zone for the first time, it does
// so by an operator of the cut.
//
// That the state reaches a fact outside the zone needs a search for few facts only. Facts of the zone cost at least as
// much as the goal, since operators without a cost make nothing more expensive than their supporter. A cheaper fact has
// a path through facts that cost no more than itself, by its cheapest achievers: one outside the zone.
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
