#ifndef RELAX_HEURISTICS_RELAXED_PLAN_HPP
#define RELAX_HEURISTICS_RELAXED_PLAN_HPP

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "relax/base/limits.hpp"
#include "relax/heuristics/relaxed_task.hpp"

namespace relax {

// Two heuristics that promise nothing and guide well: the additive heuristic (Bonet and Geffner 2001), which adds up
// the costs of preconditions as if nothing were shared, and the FF heuristic (Hoffmann and Nebel 2001), the cost of the
// relaxed plan made of the additive heuristic's cheapest achievers.
//
// What they estimate is how much is left to do: an operator weighs its cost and the mean cost of an action besides, so
// that decompositions, which are free, count as well. A relaxed plan does everything once; FF adds the least weight of
// a decomposition for every repetition of a task in the network, and says at least what decompositions weigh together.
class RelaxedPlan {
public:
    static constexpr bool kReadsOperators = false;

    RelaxedPlan(const RelaxedModel& model, Limits& limits);

    // Both throw Stopped.

    // Returns the additive estimate, or nothing where a goal is out of reach.
    std::optional<Cost> add(const RelaxedTask& task);
    // Returns the weight of the relaxed plan, or nothing where a goal is out of reach.
    std::optional<Cost> ff(const RelaxedTask& task);
    // How many operators it has looked at so far, again and again.
    std::uint64_t work() const { return work_; }
    // Whether the latest relaxed plan contains the operator.
    bool uses(OperatorId op) const { return in_plan_[op] == epoch_; }

private:
    struct FactState {
        Cost cost;
        OperatorId achiever;
        std::uint32_t epoch;
    };
    struct OperatorState {
        Cost cost;              // its weight, and the costs of the preconditions reached so far
        std::uint32_t missing;  // preconditions not yet reached
        std::uint32_t epoch;
    };
    using QueueEntry = std::pair<Cost, RelaxedFact>;
    static constexpr OperatorId kGiven = static_cast<OperatorId>(-1);

    void offer(RelaxedFact fact, Cost cost, OperatorId achiever);
    void weigh_tasks();
    Cost goal_costs(const RelaxedTask& task) const;
    Cost extract_plan(const RelaxedTask& task);

    const RelaxedModel& model_;
    Limits& limits_;
    std::vector<Cost> weight_;                  // by OperatorId
    std::vector<std::uint32_t> preconditions_;  // by OperatorId: how many
    std::vector<Cost> least_weight_;            // by TaskId: of a decomposition
    std::vector<FactState> facts_;
    std::vector<OperatorState> operators_;
    std::vector<std::uint32_t> in_plan_;  // by OperatorId: the epoch in which the relaxed plan used it
    std::vector<std::uint32_t> wanted_;   // by RelaxedFact: the epoch in which the relaxed plan needed it
    std::vector<RelaxedFact> pending_;
    std::vector<RelaxedFact> goals_;
    std::vector<QueueEntry> queue_;
    std::uint32_t epoch_ = 0;
    std::uint64_t work_ = 0;
};

}  // namespace relax

#endif
