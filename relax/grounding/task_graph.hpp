#ifndef RELAX_GROUNDING_TASK_GRAPH_HPP
#define RELAX_GROUNDING_TASK_GRAPH_HPP

#include <cstdint>
#include <utility>
#include <vector>

#include "demand.hpp"
#include "facts.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/rows.hpp"

namespace relax::grounding {

// A task instance: its relation's first number plus its tuple's number. Actions
// first.
using NodeId = std::uint32_t;
using MethodInstanceId = std::uint32_t;

// The decomposition graph below the initial task, and which parts of it are
// still in use.
struct TaskGraph {
    std::vector<NodeId> task_begin;  // by lifted task; one more entry than there are tasks
    std::uint32_t action_node_count = 0;
    NodeId initial = 0;
    std::vector<std::uint32_t> method_schema;  // by MethodInstanceId
    std::vector<NodeId> method_task;
    Rows<ObjectId> method_arguments;
    Rows<NodeId, MethodInstanceId> method_subtasks;
    // By compound node less action_node_count: its methods, which are numbered
    // one after the other.
    std::vector<std::pair<MethodInstanceId, MethodInstanceId>> methods_of;
    std::vector<bool> is_node_alive;
    std::vector<bool> is_method_alive;
};

// Instantiate the methods of the tasks that the initial task leads to. The
// initial task must have been reached.
TaskGraph expand_methods(Knowledge& knowledge, const Demand& demand, Limits& limits);

// Drop what has no finite decomposition into living actions.
void prune_bottom_up(TaskGraph& graph, Limits& limits);

// Drop what no decomposition of the initial task contains.
void prune_top_down(TaskGraph& graph, Limits& limits);

}  // namespace relax::grounding

#endif
