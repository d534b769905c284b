#ifndef RELAX_SEARCH_LABEL_SPACE_HPP
#define RELAX_SEARCH_LABEL_SPACE_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relax/base/id_table.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/task_network.hpp"
#include "relax/problem/state.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/action_lists.hpp"
#include "relax/search/search_node.hpp"
#include "relax/valuations/valuation.hpp"

namespace relax {

using LabelId = Id<struct LabelTag>;

// An action that is executed, and the parts of its cost that are due then.
struct Execution {
    ActionId action;
    std::span<const CostPartId> due_parts;
};

// What leads from a node to the next: a step, and those that are forced after it.
struct Edge {
    NodeId to;
    std::span<const SearchStep> steps;
    std::span<const Execution> executions;
    std::span<const Cost> costs;  // by price: what these cost
};

// A way to a node: what it has cost, and which actions it has executed as far as plans are told apart by them.
struct Label {
    NodeId node;
    ValueId value;
    ActionListId actions;
    LabelId parent;       // itself for the root
    const Edge* edge;     // from the parent; none for the root
    Worth bound;          // of the worth of each completion
    std::uint32_t stage;  // of that bound
    bool is_kept;
    bool is_expanded;
};

// Nodes, each a state and a network, and for each the labels that are kept: the ways to it that may lead to plans that
// are wanted. Of plans that differ in their actions, `count` are wanted. A label is superfluous if
//
// (1) another one with the same actions is as good: completed alike, it leads to the same plan, worth at most as much;
// (2) or `count` others are as good, no two of them with the same actions. What completes the label to a plan completes
//     each of these to a plan, worth at most as much; no two of those have the same actions.
//
// No plan that is wanted is lost. Call a plan lost if it is not found, though it is worth less than the `count`-th that
// is found and than the bounds of all open labels. Of all lost plans worth least, and all labels on ways to them that
// were kept and expanded, take the one with the fewest steps to go. The next label on that way was generated, and is
// not open. So it was kept and expanded, against the choice; or it was superfluous. In case (1) the same holds of the
// other label, which leads to that plan in as many steps. In case (2) its completions by the same steps are `count`
// plans worth at most as much; if all were found, the plan would not be lost, and one that was not is lost, too, with
// fewer steps to go. (Being as good may stand on a label that was dropped later, for others that are as good as that.)
class LabelSpace {
public:
    LabelSpace(Valuation& valuation, std::size_t count, bool limits_labels)
        : valuation_(valuation),
          price_count_(valuation.prices().size()),
          count_(count),
          limits_labels_(limits_labels) {}

    struct Node {
        StateId state;
        NetworkId network;
        std::span<Cost> least;        // by price: what completing it costs at least
        std::uint32_t asked;          // the heuristics at so many of the prices have been asked about it
        bool is_expanded;             // `edges` are known
        std::span<const Edge> edges;  // to the node's successors
    };

    Label& operator[](LabelId id) { return labels_[id]; }
    const Label& operator[](LabelId id) const { return labels_[id]; }
    Node& node(NodeId id) { return nodes_[id]; }
    Node& node_of(LabelId id) { return nodes_[labels_[id].node]; }
    CostToCome to_come(NodeId id) const { return {nodes_[id].network, nodes_[id].least}; }

    // The node of a state and a network; new ones have `least` 0.
    NodeId find_node(StateId state, NetworkId network);
    void set_edges(NodeId node, std::span<const Edge> edges);
    // Copies that stay.
    std::span<const CostPartId> store(std::span<const CostPartId> parts);
    Edge make_edge(NodeId to, std::span<const SearchStep> steps, std::span<const Execution> executions);

    // Add a label, unless it is superfluous; those that become superfluous are no longer kept.
    std::optional<LabelId> add(const Label& label);
    // Whether a label was dropped that may have led to another plan.
    bool has_pruned() const { return has_pruned_; }

private:
    struct Kept {
        LabelId id;
        ValueId value;
        ActionListId actions;
    };

    std::optional<LabelId> add_in_order(const Label& label);
    bool is_superfluous(const Kept& label, const std::vector<Kept>& kept, const CostToCome& to_come);
    LabelId store(const Label& label, std::vector<Kept>& kept, std::size_t place);

    Valuation& valuation_;
    std::size_t price_count_;
    std::size_t count_;
    bool limits_labels_;
    SegmentedArray<Node> nodes_;
    SegmentedArray<std::vector<Kept>> kept_;  // by NodeId; in the order of their worth where that is total
    IdTable<NodeId> node_table_;
    RunArena<Cost> costs_;
    RunArena<Edge> edges_;
    RunArena<CostPartId> parts_;
    RunArena<SearchStep> steps_;
    RunArena<Execution> executions_;
    SegmentedArray<Label> labels_;
    std::vector<ValueId> values_;
    std::vector<ActionListId> lists_;
    bool has_pruned_ = false;
};

}  // namespace relax

#endif
