#ifndef RELAX_GROUNDING_COMPOSITION_HPP
#define RELAX_GROUNDING_COMPOSITION_HPP

#include <cstdint>
#include <utility>
#include <vector>

#include "relax/grounding/grounder.hpp"
#include "task_graph.hpp"

namespace relax::grounding {

using Ordering = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// A method's network, where the only methods of some subtasks have been applied.
struct ComposedNetwork {
    // A method instance that was applied. The first is the method itself; the others come after their parents.
    struct Part {
        MethodInstanceId method;
        std::uint32_t parent;    // index of a part; of the first: 0
        std::uint32_t position;  // of the task that was decomposed, among the parent's lifted subtasks
    };
    struct Subtask {
        NodeId node;
        std::uint32_t part;
        std::uint32_t position;  // among the part's lifted subtasks
    };
    std::vector<Part> parts;
    std::vector<Subtask> subtasks;
    Ordering ordering;  // indices of subtasks; transitively closed, sorted
};

// Makes the networks of the ground problem from the living methods: trivial subtasks vanish, methods that equal another
// one of the same task too, and a task with a single method gives way to the subtasks of that method.
class Composition {
public:
    // `is_trivial`: by action node, whether it has no precondition and no effect. `stands_for`: by action node, an
    // equal one.
    Composition(const LiftedProblem& lifted, TaskGraph& graph, const std::vector<bool>& is_trivial,
                const std::vector<NodeId>& stands_for, const GroundingOptions& options, Limits& limits);

    // Whether a living compound task remains.
    bool is_kept(NodeId compound) const { return !is_replaced_[compound]; }
    ComposedNetwork compose(MethodInstanceId method) const;

private:
    bool is_compound(NodeId node) const { return node >= graph_.action_node_count; }
    bool vanishes(NodeId node) const { return !is_compound(node) && is_trivial_[node]; }
    void drop_equal_methods(Limits& limits);
    void choose_replaced(Limits& limits);
    void append(MethodInstanceId method, std::uint32_t parent, std::uint32_t position, ComposedNetwork& network) const;

    TaskGraph& graph_;
    Limits& limits_;
    const std::vector<bool>& is_trivial_;
    const std::vector<NodeId>& stands_for_;
    std::vector<Ordering> orderings_;  // by lifted method: its transitive closure
    std::vector<bool> is_replaced_;    // by node
};

}  // namespace relax::grounding

#endif
