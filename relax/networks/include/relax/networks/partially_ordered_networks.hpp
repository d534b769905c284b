#ifndef RELAX_NETWORKS_PARTIALLY_ORDERED_NETWORKS_HPP
#define RELAX_NETWORKS_PARTIALLY_ORDERED_NETWORKS_HPP

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "relax/base/id_table.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/network_components.hpp"
#include "relax/networks/ordered_tasks.hpp"
#include "relax/networks/task_network.hpp"

namespace relax {

// Networks as bags of components: tasks of one have no order with those of another. A step changes one component, which
// may fall into several, and what becomes of it is the same in every network; so it is found out once. An occurrence's
// index counts through the components in the order of their numbers.
class PartiallyOrderedNetworks final : public TaskNetworks {
public:
    PartiallyOrderedNetworks(const GroundProblem& problem, Limits& limits);

    NetworkId initial() override;
    void unconstrained(NetworkId network, std::vector<Occurrence>& occurrences) const override;
    void tasks(NetworkId network, std::vector<TaskId>& tasks) const override;
    bool are_totally_ordered() const override { return false; }
    void ordered_tasks(NetworkId network, OrderedTasks& ordered) const override;
    NetworkId progress(NetworkId network, std::uint32_t index, std::vector<Origin>* origins) override;
    NetworkId decompose(NetworkId network, std::uint32_t index, MethodId method, std::vector<Origin>* origins) override;
    Cost bound(NetworkId network, std::span<const Cost> task_bounds, const SegmentedArray<Cost>& by_network,
               SegmentedArray<Cost>& by_component) const override;
    std::uint32_t size(NetworkId network) const override { return records_[network].size; }
    std::uint64_t work() const override { return work_ + components_.work(); }

private:
    struct Record {
        const ComponentId* components;  // sorted
        std::uint32_t count;            // of components
        std::uint32_t size;
    };
    // What becomes of a component by a step.
    struct Transition {
        ComponentId from;
        std::uint32_t index;
        MethodId method;  // kExecuted where the task is executed
        std::uint32_t count;
        const ComponentId* to;
    };
    // A component of the network being built, and where its occurrences come from.
    struct Part {
        ComponentId id;
        std::vector<Origin> origins;
    };
    static constexpr MethodId kExecuted{std::numeric_limits<std::uint32_t>::max()};

    std::span<const ComponentId> components(NetworkId network) const {
        return {records_[network].components, records_[network].count};
    }
    NetworkId step(NetworkId network, std::uint32_t index, MethodId method, std::vector<Origin>* origins);
    std::span<const ComponentId> change(ComponentId component, std::uint32_t index, MethodId method);
    void replace(ComponentId component, std::uint32_t index, MethodId method);
    void split(std::vector<Part>& parts);
    void trace(NetworkId network, std::size_t changed, std::uint32_t begin, std::uint32_t index, MethodId method,
               std::vector<Origin>& origins);
    NetworkId intern(std::span<const ComponentId> components);

    const GroundProblem& problem_;
    Limits& limits_;
    NetworkComponents components_;
    RunArena<ComponentId> lists_;
    SegmentedArray<Record> records_;
    IdTable<NetworkId> table_;
    SegmentedArray<Transition> transitions_;
    IdTable<> transition_table_;

    // The component being changed.
    OrderedTasks draft_;
    std::vector<Origin> draft_origins_;
    std::vector<std::uint32_t> part_of_;  // by index in the draft
    std::vector<std::uint32_t> place_;    // likewise, in its part
    std::vector<Part> parts_;
    std::vector<std::uint32_t> order_;
    OrderedTasks part_;
    // The network being built.
    std::vector<ComponentId> list_;
    std::uint64_t work_ = 0;  // besides making components
};

}  // namespace relax

#endif
