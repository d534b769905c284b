#ifndef RELAX_HEURISTICS_HMAX_HPP
#define RELAX_HEURISTICS_HMAX_HPP

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "relax/base/cost.hpp"
#include "relax/base/limits.hpp"
#include "relax/heuristics/relaxed_task.hpp"

namespace relax {

// The max heuristic (Bonet and Geffner 2001): the cost of a fact is that of its cheapest achiever, the cost of an
// operator's preconditions is that of the most expensive one. Computed as a generalised Dijkstra search.
//
// Admissible, also where an action's operators share an owner, which pays for each on a path: by induction along a
// plan, a fact that holds after some of its steps costs at most what these steps cost. The step that made it was
// executed in a state whose facts cost no more than the steps before it, and it cost what its operator costs, with the
// cost parts that were due there.
//
// Keeps what LM-cut needs: each operator's supporter (the precondition of the highest cost), and an incremental update
// for operators that become cheaper.
//
// The readers of a state's facts are never looked up, since most of a model reads some. An operator with such
// preconditions counts those that are not yet reached when it wakes up: at the start (composition model) or when its
// action may start (decomposition model).
class HMax {
public:
    HMax(const RelaxedModel& model, Limits& limits);

    // Both computations throw Stopped; after that, the next one must be from scratch.

    // Compute from scratch; `costs` by OwnerId. Returns the cost of the most expensive goal, or nothing where one is
    // out of reach.
    std::optional<Cost> run(const RelaxedTask& task, std::span<const Cost> costs);

    // Update after the costs of the owners of these operators have been lowered. Returns the cost of the most expensive
    // goal.
    Cost lower(const RelaxedTask& task, std::span<const OperatorId> operators, std::span<const Cost> costs);

    Cost cost(RelaxedFact fact) const { return facts_[fact].epoch == epoch_ ? facts_[fact].cost : kInfinity; }
    // An operator of this task all of whose preconditions are within reach.
    bool is_reached(OperatorId op) const { return operators_[op].epoch == epoch_ && operators_[op].missing == 0; }
    RelaxedFact supporter(OperatorId op) const { return operators_[op].supporter; }
    // How many operators have been looked at so far.
    std::uint64_t work() const { return looks_; }
    // The most expensive goal; meaningless where there are no goals.
    RelaxedFact most_expensive_goal() const { return most_expensive_goal_; }

private:
    struct FactState {
        Cost cost;
        std::uint32_t epoch;
        bool is_settled;  // has left the queue, or holds in the state
    };
    struct OperatorState {
        Cost supporter_cost;
        RelaxedFact supporter;
        std::uint32_t missing;  // preconditions not yet reached
        std::uint32_t epoch;
        std::uint32_t count;  // of the preconditions; 0 for an operator that wakes up
    };
    using QueueEntry = std::pair<Cost, RelaxedFact>;

    void make_room(const RelaxedTask& task);
    void wake(const RelaxedTask& task, OperatorId op, RelaxedFact fact, Cost cost, std::span<const Cost> costs);
    void reach(const RelaxedTask& task, OperatorId op, RelaxedFact fact, Cost cost, std::span<const Cost> costs);
    void offer(RelaxedFact fact, Cost cost);
    bool is_empty() const { return queue_.empty() && level_facts_.empty(); }
    QueueEntry pop();
    void support_by_most_expensive(std::span<const RelaxedFact> preconditions, OperatorState& state) const;
    Cost find_most_expensive_goal(std::span<const RelaxedFact> goals);

    const RelaxedModel& model_;
    Limits& limits_;
    std::vector<FactState> facts_;
    std::vector<OperatorState> operators_;
    // The queue: facts of the present level, and a heap of the more expensive ones, cheapest first.
    Cost level_ = 0;
    std::vector<RelaxedFact> level_facts_;
    std::vector<QueueEntry> queue_;
    RelaxedFact most_expensive_goal_ = 0;
    std::uint32_t epoch_ = 0;
    std::uint64_t looks_ = 0;
};

}  // namespace relax

#endif
