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

// Lists of tasks: a first task and the number of the rest. Equal lists have equal numbers.
//
// The form of a network is the network with every maximal run of consecutive actions replaced by its macro-action; runs
// that need and make nothing vanish. (Actions with conditions on effects or costs stand for themselves.) Two networks
// of one form have the same compound tasks in the same order and, between them, runs that need and make the same
// literals. Hence from any state that can be reached the same continuations complete both: take a plan of one and
// replace its runs by those of the other. By induction over the runs the states stay the same, which keeps every case
// and every cost part of the other actions; so completing one costs `bound(one) - bound(other)` more than completing
// the other: compound tasks and actions with cost parts contribute equally to `bound`, and of all other actions it is
// the cost.
//
// The same holds where states forget facts that a network does not read (RelevantFacts). Let two nodes have equal
// states so reduced, and networks of one form. What a common task reads, and what a run needs, both networks read: of
// these facts both nodes know the truth, and it is the same. Any other fact that a run reads it has made itself before,
// so that its truth does not matter.
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
    Cost bound(NetworkId network, std::span<const Cost> task_bounds, const SegmentedArray<Cost>& by_network,
               SegmentedArray<Cost>& /*by_component*/) const override {
        const Cell& cell = cells_[network];
        return network == kEmpty ? 0 : add_bounds(by_network[cell.rest], task_bounds[cell.first]);
    }
    std::uint32_t size(NetworkId network) const override { return cells_[network].size; }
    FormId form(NetworkId network) const override {
        return macros_ ? cells_[network].form : TaskNetworks::form(network);
    }
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
    static constexpr NetworkId kEmpty{0};
    static constexpr FormId kEmptyForm{0};
    static constexpr FormId kImpossible{std::numeric_limits<std::uint32_t>::max()};

    NetworkId intern(TaskId first, NetworkId rest);
    FormId form_of(TaskId first, FormId rest);
    FormId intern_form(std::uint32_t first, FormId rest);

    const GroundProblem& problem_;
    const Rows<std::uint32_t>& sequences_;
    SegmentedArray<Cell> cells_;
    IdTable<NetworkId> table_;
    std::vector<TaskId> earlier_;
    std::optional<MacroActions> macros_;
    SegmentedArray<Form> forms_;
    IdTable<FormId> form_table_;
};

}  // namespace relax

#endif
