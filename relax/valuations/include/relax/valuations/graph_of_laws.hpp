#ifndef RELAX_VALUATIONS_GRAPH_OF_LAWS_HPP
#define RELAX_VALUATIONS_GRAPH_OF_LAWS_HPP

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/task_network.hpp"
#include "relax/problem/ground_problem.hpp"
#include "relax/valuations/law_table.hpp"

namespace relax {

// The graph of laws: of every task a law G that no decomposition of it comes below, states ignored. For each cost x,
// G(x) is a bound on the probability that a decomposition costs at most x: of an action that of its own law, of a
// compound task the largest over its methods of the convolution of its subtasks' G. It is the least fixed point.
//
// A bound for all plans, and for agents that look at what has been spent before they decide, too: by induction over the
// decomposition, the cost of each subtask is stochastically at least G whatever the others cost, sums of such costs are
// at least the sum of independent ones with laws G, and a law that is for each x at most one of several cdfs is at most
// their maximum. An action has a law that its cost is stochastically at least in whatever state (see `least_laws`).
//
// A task is worked out again when one of its subtasks has changed. Cycles make that end late, or never: after so many
// times a task is taken to cost its least cost for certain, which bounds everything. Changes of less than 2^-46 are
// ignored, and so is rounding; each may have come together from a decomposition of up to 2^13 tasks, so that in the end
// 2^-32 of each compound task's probability is moved from the largest costs to the least one.
class GraphOfLaws {
public:
    // `action_laws`: by ActionId, of `table`, where all others are kept, too. `least`, `means`: by TaskId, see
    // tdg_bound, of the least costs in steps and of expected costs in any unit. Throws Stopped.
    GraphOfLaws(const GroundProblem& problem, LawTable& table, std::span<const LawId> action_laws,
                std::span<const Cost> least, std::span<const Cost> means, Limits& limits);

    // Of a task that has a decomposition.
    LawId operator[](TaskId task) const { return laws_[task]; }

private:
    bool update(TaskId task, Limits& limits);

    const GroundProblem& problem_;
    LawTable& table_;
    std::vector<LawId> laws_;           // by TaskId
    std::vector<bool> is_known_;        // likewise
    std::vector<std::uint8_t> rounds_;  // likewise
    std::vector<double> at_;
    std::vector<double> probability_;
};

// The sums of the laws of the tasks of networks, each worked out when it is asked for.
class NetworkLaws {
public:
    // `task_table`: that of the graph; the sums are kept in `table`.
    NetworkLaws(const TaskNetworks& networks, const GraphOfLaws& graph, const LawTable& task_table, LawTable& table)
        : networks_(networks), graph_(graph), task_table_(task_table), table_(table) {}

    // Throws Stopped.
    const Law& of(NetworkId network, Limits& limits);

private:
    static constexpr LawId kUnknown{std::numeric_limits<std::uint32_t>::max()};

    LawId of_task(TaskId task);

    const TaskNetworks& networks_;
    const GraphOfLaws& graph_;
    const LawTable& task_table_;
    LawTable& table_;
    std::vector<LawId> by_task_;
    SegmentedArray<LawId> by_network_;
    std::vector<TaskId> tasks_;
    std::vector<LawId> laws_;
};

}  // namespace relax

#endif
