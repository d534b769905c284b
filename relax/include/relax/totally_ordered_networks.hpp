#ifndef RELAX_TOTALLY_ORDERED_NETWORKS_HPP
#define RELAX_TOTALLY_ORDERED_NETWORKS_HPP

#include <vector>

#include "relax/id_table.hpp"
#include "relax/segmented_array.hpp"
#include "relax/task_network.hpp"

namespace relax {

// Lists of tasks: a first task and the number of the rest. Equal lists have equal numbers.
class TotallyOrderedNetworks final : public TaskNetworks {
public:
    TotallyOrderedNetworks(const GroundProblem& problem, std::vector<Cost> task_bounds);

    // Every method orders its subtasks totally.
    static bool fits(const GroundProblem& problem);

    NetworkId initial() override;
    void unconstrained(NetworkId network, std::vector<Occurrence>& occurrences) const override;
    void tasks(NetworkId network, std::vector<TaskId>& tasks) const override;
    bool are_totally_ordered() const override { return true; }
    void ordered_tasks(NetworkId network, OrderedTasks& ordered) const override;
    NetworkId progress(NetworkId network, std::uint32_t index, std::vector<Origin>* origins) override;
    NetworkId decompose(NetworkId network, std::uint32_t index, MethodId method, std::vector<Origin>* origins) override;
    Cost bound(NetworkId network) const override { return cells_[network].bound; }
    std::uint32_t size(NetworkId network) const override { return cells_[network].size; }

private:
    struct Cell {
        Cost bound;
        TaskId first;
        NetworkId rest;
        std::uint32_t size;
    };
    static constexpr NetworkId kEmpty = 0;

    NetworkId intern(TaskId first, NetworkId rest);

    const GroundProblem& problem_;
    std::vector<Cost> task_bounds_;
    Rows<std::uint32_t> sequence_;  // by MethodId: indices of its subtasks, in their order
    SegmentedArray<Cell> cells_;
    IdTable table_;
    std::vector<TaskId> earlier_;
};

}  // namespace relax

#endif
