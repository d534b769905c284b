#ifndef RELAX_PROGRESSION_RELEVANT_FACTS_HPP
#define RELAX_PROGRESSION_RELEVANT_FACTS_HPP

#include <cstdint>
#include <span>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/task_network.hpp"
#include "relax/problem/ground_problem.hpp"
#include "relax/problem/state.hpp"

namespace relax {

// Which facts matter to what is left to do: those that some action reads, as a precondition of either sign or as a
// condition of an effect or of a part of the cost, which the network's tasks can still lead to. (The goal is an action
// of the network.) States that agree on them are the same to a network.
class RelevantFacts {
public:
    RelevantFacts(const GroundProblem& problem, Limits& limits);

    // As bits by FactId. Valid for ever. Throws Stopped.
    std::span<const std::uint64_t> of(TaskNetworks& networks, NetworkId network);

private:
    using MaskId = StateId;
    static constexpr MaskId kUnknown = static_cast<MaskId>(-1);

    std::span<const std::uint64_t> of(TaskId task) const {
        return std::span(masks_of_components_).subspan(component_[task] * words_, words_);
    }
    void find_components();
    void close_component(std::span<const TaskId> members);
    void add_reads(ActionId action);
    MaskId find(TaskNetworks& networks, NetworkId network);
    MaskId find_in_chain(TaskNetworks& networks, NetworkId network);
    MaskId& known(NetworkId network);

    const GroundProblem& problem_;
    Limits& limits_;
    std::size_t words_;
    // By TaskId: its strongly connected component in the task decomposition graph; by component: what is read below it.
    std::vector<std::uint32_t> component_;
    std::vector<std::uint64_t> masks_of_components_;
    std::uint32_t component_count_ = 0;

    StateRegistry masks_;
    SegmentedArray<MaskId> mask_of_network_;
    StateBits mask_;
    std::vector<NetworkId> chain_;
    std::vector<Occurrence> first_;
    std::vector<TaskId> tasks_;
};

}  // namespace relax

#endif
