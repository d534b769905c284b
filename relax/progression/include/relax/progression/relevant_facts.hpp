#ifndef RELAX_PROGRESSION_RELEVANT_FACTS_HPP
#define RELAX_PROGRESSION_RELEVANT_FACTS_HPP

#include <cstdint>
#include <span>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/task_network.hpp"
#include "relax/problem/state.hpp"

namespace relax {

// Which facts matter to what is left to do: those that the actions read to which the network's tasks can still lead.
// (The goal is an action of the network.) States that agree on them are the same to a network.
class RelevantFacts {
public:
    RelevantFacts(const AnalysedProblem& problem, Limits& limits);  // throws Stopped

    // As bits by FactId. Valid for ever. Throws Stopped.
    std::span<const std::uint64_t> of(TaskNetworks& networks, NetworkId network);

private:
    using MaskId = StateId;
    static constexpr MaskId kUnknown = static_cast<MaskId>(-1);

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
