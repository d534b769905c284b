#ifndef RELAX_NETWORKS_TOTALLY_ORDERED_NETWORKS_HPP
#define RELAX_NETWORKS_TOTALLY_ORDERED_NETWORKS_HPP

#include <optional>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/base/cost.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/rows.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/macro_actions.hpp"
#include "relax/networks/task_network.hpp"

namespace relax {

// Lists of tasks: a first task and the number of the rest. Equal lists have equal numbers. Actions that stand together
// in a list will be executed one after the other, so a list's form has a macro-action in their place.
class TotallyOrderedNetworks final : public TaskNetworks {
public:
    // `use_macros`: whether forms are wanted. Methods that do not order their subtasks totally are taken as if they
    // did.
    TotallyOrderedNetworks(const AnalysedProblem& problem, bool use_macros, Limits& limits);

    // Every method orders its subtasks totally.
    static bool fits(const GroundProblem& problem);

    NetworkId initial() override;
    void unconstrained(NetworkId network, std::vector<Occurrence>& occurrences) const override;
    void tasks(NetworkId network, std::vector<TaskId>& tasks) const override;
    bool are_totally_ordered() const override { return true; }
    void ordered_tasks(NetworkId network, OrderedTasks& ordered) const override;
    NetworkId progress(NetworkId network, std::uint32_t index, std::vector<Origin>* origins) override;
    NetworkId decompose(NetworkId network, std::uint32_t index, MethodId method, std::vector<Origin>* origins) override;
    Cost bound(NetworkId network, std::span<const Cost> task_bounds, const FlatArray<Cost>& by_network,
               FlatArray<Cost>& /*by_component*/) const override {
        const Cell& cell = cells_[network];
        return network == kEmpty ? 0 : add_bounds(by_network[cell.rest], task_bounds[cell.first]);
    }
    std::uint32_t size(NetworkId network) const override { return cells_[network].size; }
    FormId form(NetworkId network) const override { return macros_ ? cells_[network].form : network; }
    bool is_impossible(NetworkId network) const override { return macros_ && cells_[network].form == kImpossible; }

private:
    struct Cell {
        TaskId first;
        NetworkId rest;
        std::uint32_t size;
        FormId form;
    };
    // A list of tasks and macro-actions: the latter's numbers come after those of tasks.
    struct Form {
        std::uint32_t first;
        FormId rest;
    };
    static constexpr NetworkId kEmpty = 0;
    static constexpr FormId kImpossible = static_cast<FormId>(-1);

    NetworkId intern(TaskId first, NetworkId rest);
    FormId form_of(TaskId first, FormId rest);
    FormId intern_form(std::uint32_t first, FormId rest);

    const GroundProblem& problem_;
    const Rows<std::uint32_t>& sequences_;
    SegmentedArray<Cell> cells_;
    IdTable table_;
    std::vector<TaskId> earlier_;
    std::optional<MacroActions> macros_;
    SegmentedArray<Form> forms_;
    IdTable form_table_;
};

}  // namespace relax

#endif
