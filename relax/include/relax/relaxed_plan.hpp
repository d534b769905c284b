#ifndef RELAX_RELAXED_PLAN_HPP
#define RELAX_RELAXED_PLAN_HPP

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "relax/relaxed_model.hpp"

namespace relax {

// Two heuristics that promise nothing and guide well: the additive heuristic (Bonet and Geffner 2001), which adds up
// the costs of preconditions as if nothing were shared, and the FF heuristic (Hoffmann and Nebel 2001), the cost of the
// relaxed plan made of the additive heuristic's cheapest achievers.
//
// What they estimate is how much is left to do: an operator weighs its cost and the mean cost of an action besides, so
// that decompositions, which are free, count as well.
class RelaxedPlan {
public:
    explicit RelaxedPlan(const RelaxedModel& model);

    // Returns the additive estimate, or nothing where a goal is out of reach.
    std::optional<Cost> add(const RelaxedTask& task);
    // Returns the weight of the relaxed plan, or nothing where a goal is out of reach.
    std::optional<Cost> ff(const RelaxedTask& task);
    // Whether the latest relaxed plan contains the operator.
    bool uses(OperatorId op) const { return in_plan_[op] == epoch_; }

private:
    struct FactState {
        Cost cost;
        OperatorId achiever;
        std::uint32_t epoch;
    };
    struct OperatorState {
        Cost cost;              // sum over the preconditions reached so far
        std::uint32_t missing;  // preconditions not yet reached
        std::uint32_t epoch;
    };
    using QueueEntry = std::pair<Cost, RelaxedFact>;
    static constexpr OperatorId kGiven = static_cast<OperatorId>(-1);

    void offer(RelaxedFact fact, Cost cost, OperatorId achiever);
    Cost weight(OperatorId op) const { return model_.owner_cost[model_.owner[op]] + step_; }

    const RelaxedModel& model_;
    Cost step_ = 1;
    std::vector<FactState> facts_;
    std::vector<OperatorState> operators_;
    std::vector<std::uint32_t> in_plan_;  // by OperatorId: the epoch in which the relaxed plan used it
    std::vector<std::uint32_t> wanted_;   // by RelaxedFact: the epoch in which the relaxed plan needed it
    std::vector<RelaxedFact> pending_;
    std::vector<QueueEntry> queue_;
    std::uint32_t epoch_ = 0;
};

}  // namespace relax

#endif
