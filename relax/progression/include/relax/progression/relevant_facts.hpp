#ifndef RELAX_PROGRESSION_RELEVANT_FACTS_HPP
#define RELAX_PROGRESSION_RELEVANT_FACTS_HPP

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/task_network.hpp"
#include "relax/problem/state.hpp"

namespace relax {

// Which facts matter to a network: those that the actions read to which its tasks can lead, as a precondition or as a
// condition of an effect or of the cost. (The goal is an action of the network.) States forget the others, which then
// count as false.
//
// No plan is lost, none is gained, and each keeps its cost: what a network's successors read, the network reads. So
// along a plan the reduced state agrees with the full one on every fact that is still read; actions are applicable in
// both or in neither, and have the same cases and cost parts. Nor does a heuristic rise by it: the operators that are
// reachable from the network read no fact that is forgotten.
class RelevantFacts {
public:
    RelevantFacts(const AnalysedProblem& problem, Limits& limits);  // throws Stopped

    // As bits by FactId. Valid for ever. Throws Stopped.
    std::span<const std::uint64_t> of(TaskNetworks& networks, NetworkId network);

private:
    using MaskId = StateId;
    static constexpr MaskId kUnknown{std::numeric_limits<std::uint32_t>::max()};

    MaskId find(TaskNetworks& networks, NetworkId network);
    MaskId find_in_chain(TaskNetworks& networks, NetworkId network);
    MaskId& known(NetworkId network);

    Limits& limits_;
    const TaskReads& reads_;
    StateRegistry masks_;
    SegmentedArray<MaskId> mask_of_network_;
    StateBits mask_;
    std::vector<NetworkId> chain_;
    std::vector<Occurrence> first_;
    std::vector<TaskId> tasks_;
};

}  // namespace relax

#endif
