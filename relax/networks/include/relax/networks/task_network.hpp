#ifndef RELAX_NETWORKS_TASK_NETWORK_HPP
#define RELAX_NETWORKS_TASK_NETWORK_HPP

// Task networks as the search meets them: immutable, each kept once and known by a number. Where every method is
// totally ordered, a network is a list that shares its rest with others (TotallyOrderedNetworks); otherwise it is a set
// of components, each a set of occurrences with a transitively closed order in a canonical form
// (PartiallyOrderedNetworks).

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/ordered_tasks.hpp"

namespace relax {

using NetworkId = Id<struct NetworkTag>;
using FormId = Id<struct FormTag>;

// An occurrence of a task in a network: its index there.
struct Occurrence {
    std::uint32_t index;
    TaskId task;
};

// Where an occurrence of a network comes from: an occurrence of the network before, or a subtask of the method applied.
struct Origin {
    bool is_subtask;
    std::uint32_t index;
};

// Making networks may throw Stopped; those that were made stay.
class TaskNetworks {
public:
    virtual ~TaskNetworks() = default;

    // The network of the initial task alone.
    virtual NetworkId initial() = 0;
    // Append the occurrences that nothing is ordered before.
    virtual void unconstrained(NetworkId network, std::vector<Occurrence>& occurrences) const = 0;
    // Append every task of the network by index, with repetitions.
    virtual void tasks(NetworkId network, std::vector<TaskId>& tasks) const = 0;
    // Whether every network is a list, its tasks in the order of their indices.
    virtual bool are_totally_ordered() const = 0;
    // Write the tasks by index, and their order.
    virtual void ordered_tasks(NetworkId network, OrderedTasks& ordered) const = 0;
    // Take an unconstrained occurrence away. `origins`, where given, gets one entry for each occurrence of the result.
    virtual NetworkId progress(NetworkId network, std::uint32_t index, std::vector<Origin>* origins = nullptr) = 0;
    // Replace an occurrence, constrained or not, by the method's subtasks.
    virtual NetworkId decompose(NetworkId network, std::uint32_t index, MethodId method,
                                std::vector<Origin>* origins = nullptr) = 0;
    // The sum of the tasks' bounds, given those of all networks made before. Components, if networks have any, are
    // added to `by_component`. (See NetworkBounds.)
    virtual Cost bound(NetworkId network, std::span<const Cost> task_bounds, const SegmentedArray<Cost>& by_network,
                       SegmentedArray<Cost>& by_component) const = 0;
    virtual std::uint32_t size(NetworkId network) const = 0;
    // Networks of one form, each with a state that it can be reached with, have the same plans but for some actions
    // between the same compound tasks, if the states agree as far as either network reads them. The cheapest plan of
    // one costs `bound(one) - bound(other)` more than that of the other.
    virtual FormId form(NetworkId network) const { return FormId(std::uint32_t{network}); }
    // Whether the network has no plan from any state that can be reached, since some actions of it exclude each other.
    virtual bool is_impossible(NetworkId /*network*/) const { return false; }

    // What it has taken so far to make networks, in tasks and words of their order that were looked at; 0 where that
    // does not grow with their size.
    virtual std::uint64_t work() const { return 0; }

    bool is_empty(NetworkId network) const { return size(network) == 0; }
};

// `in_sequence`: lists even where methods do not order their subtasks totally.
std::unique_ptr<TaskNetworks> make_task_networks(const AnalysedProblem& problem, bool use_macros, bool in_sequence,
                                                 Limits& limits);

}  // namespace relax

#endif
