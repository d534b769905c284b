#ifndef RELAX_LM_CUT_HPP
#define RELAX_LM_CUT_HPP

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relax/hmax.hpp"
#include "relax/limits.hpp"
#include "relax/relaxed_model.hpp"

namespace relax {

// The landmark-cut heuristic (Helmert and Domshlak 2009). Each round finds a set of owners (actions) one of which every
// plan of the relaxed task needs, adds the least cost among them, and takes it off all of them, until the goals are
// free.
class LmCut {
public:
    LmCut(const RelaxedModel& model, Limits& limits);

    // Returns a lower bound of the cost of any plan of the relaxed task, or nothing where there is none. A limit ends
    // the rounds early, with a lower bound all the same.
    static constexpr bool kReadsOperators = true;

    std::optional<Cost> run(const RelaxedTask& task);
    // How many operators have been looked at so far.
    std::uint64_t work() const { return looks_ + hmax_.work(); }

private:
    enum class Zone : std::uint8_t { Neither, Goal, Before };

    void mark_goal_zone(RelaxedFact goal);
    void find_cut(const RelaxedTask& task);
    void put_into_goal_zone(RelaxedFact fact);
    void put_into_cut(OwnerId owner);

    const RelaxedModel& model_;
    Limits& limits_;
    HMax hmax_;
    std::vector<Cost> costs_;                // by OwnerId, what is left of them
    std::vector<std::uint64_t> zone_round_;  // by RelaxedFact: the round in which `zone_` was set
    std::vector<Zone> zone_;                 // by RelaxedFact
    std::vector<std::uint64_t> cut_round_;   // by OwnerId: the round in which it was put into the cut
    std::vector<OwnerId> cut_;
    std::vector<OwnerId> lowered_;  // owners whose cost differs from the model's
    std::vector<OperatorId> changed_;
    std::vector<RelaxedFact> pending_;
    std::uint64_t rounds_ = 0;
    std::uint64_t looks_ = 0;
};

}  // namespace relax

#endif
