#ifndef RELAX_PROGRESSION_PROGRESSION_HPP
#define RELAX_PROGRESSION_PROGRESSION_HPP

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/networks/node_view.hpp"
#include "relax/networks/task_network.hpp"
#include "relax/problem/ground_problem.hpp"
#include "relax/problem/state.hpp"
#include "relax/progression/branching.hpp"
#include "relax/progression/first_actions.hpp"
#include "relax/progression/reachable_reads.hpp"
#include "relax/progression/relevant_facts.hpp"
#include "relax/progression/stubborn_set.hpp"

namespace relax {

// What leads from a node to the next: an action executed (no method), or a compound task decomposed.
struct SearchStep {
    std::uint32_t occurrence = 0;  // index in the network before the step
    std::optional<MethodId> method;
};

struct Successor {
    StateId state;
    NetworkId network;
    SearchStep step;
    std::optional<ActionId> action;     // that was executed; none where a task was decomposed
    std::vector<CostPartId> due_parts;  // of its cost
};

struct ProgressionSwitches {
    bool skip_dead_methods = true;  // leave out methods whose first task cannot be executed where it would come next
    bool stubborn_sets = true;      // leave out actions that can wait until others have been executed
    bool forget_facts = true;       // states keep only the facts that matter to what is left to do
};

struct ProgressionOptions : ProgressionSwitches {
    bool use_macros = false;          // actions in a row count as one (TaskNetworks::form)
    bool when_due = false;            // methods that begin with an action are not chosen until it can be executed
    bool in_sequence = false;         // tasks without an order come in that of the domain: some plans are left out
    bool forget_unreachable = false;  // states keep only the facts that actions read which are still within reach
};

// Progression over states and task networks; knows nothing of search algorithms, nor of prices.
//
// Algorithm 4 of the paper tries every unconstrained task (lines 9 and 10). Fewer successors keep a plan of every cost:
//
// - Decomposing does not depend on the state, since method preconditions are actions. So the decomposition of an
//   unconstrained compound task can come first in any plan, and the methods of one such task are enough.
// - An applicable unconstrained action that costs and changes nothing, as precondition actions do, can come first in
//   any plan. It is executed at once, whatever else is unconstrained.
// - Of the other unconstrained actions a stubborn set is enough, beside compound tasks as well. It is tried instead of
//   the methods where it has no more members than there are methods.
// - Where a compound task is the only unconstrained task, the first task of its method comes next. A method whose first
//   task is an action that is not applicable has no plan.
class Progression {
public:
    // All that makes states or networks may throw Stopped.
    //
    // `free_actions`: by ActionId, those that certainly cost nothing. Where they change nothing either, they are
    // executed at once.
    Progression(const AnalysedProblem& problem, const std::vector<bool>& free_actions,
                const ProgressionOptions& options, Limits& limits);

    StateId initial_state();
    NetworkId initial_network() { return networks_->initial(); }
    // Replace the content of `successors` by the node's successors.
    void expand(StateId state, NetworkId network, std::vector<Successor>& successors);
    // The same where there is at most one successor, or one is enough, and that is found with little work. False, and
    // no successors, elsewhere.
    bool expand_if_forced(StateId state, NetworkId network, std::vector<Successor>& successors);
    // One step: a method applied to a compound task, or an action executed, which is that of an unconstrained task or
    // an outcome action of it, and applicable.
    Successor decompose(StateId state, NetworkId network, const Occurrence& occurrence, MethodId method);
    Successor execute(StateId state, NetworkId network, const Occurrence& occurrence, ActionId action);
    // Whether an action costs and changes nothing in any state, and comes at once.
    bool is_executed_at_once(TaskId task) const { return problem_.is_primitive(task) && is_executed_at_once_[task]; }
    // Append the methods by which a compound task may be decomposed; where it comes next, those that are not dead.
    void add_methods(TaskId task, bool comes_next, StateId state, std::vector<MethodId>& methods);
    // The facts that matter to a node, true or false, as bits by FactId.
    StateBits facts_that_matter(StateId state, NetworkId network);
    // What heuristics see of a node but for its bound; valid until the next call.
    NodeView view(StateId state, NetworkId network);

    // The network's tasks and their order; valid until the next call.
    const OrderedTasks& ordered_tasks(NetworkId network) {
        networks_->ordered_tasks(network, ordered_tasks_);
        work_ += ordered_tasks_.predecessors.size();
        return ordered_tasks_;
    }

    // What the sizes of networks have cost so far, in tasks and words of their order that were looked at.
    std::uint64_t work() const { return work_ + networks_->work() + (stubborn_set_ ? stubborn_set_->work() : 0); }

    const StateRegistry& states() const { return states_; }
    TaskNetworks& networks() { return *networks_; }
    // Tell it what becomes of the nodes, and the tasks are chosen the better.
    Branching& branching() { return branching_; }

private:
    bool execute_at_once(StateId state, NetworkId network, std::vector<Successor>& successors);
    bool decompose_at_once(StateId state, NetworkId network, std::vector<Successor>& successors);
    void expand_when_due(StateId state, NetworkId network, std::vector<Successor>& successors);
    std::optional<Occurrence> compound_to_decompose() const;
    void find_live_methods(StateId state);
    void choose_actions(StateId state, NetworkId network);
    StateId keep_relevant(NetworkId network);
    Successor execute(StateId state, NetworkId network, const Occurrence& occurrence) {
        return execute(state, network, occurrence, problem_.action_of(occurrence.task));
    }

    const GroundProblem& problem_;
    StateTransition transition_;
    std::vector<bool> is_executed_at_once_;  // by ActionId: costs and changes nothing in any state, and comes at once
    StateRegistry states_;
    std::unique_ptr<TaskNetworks> networks_;
    Branching branching_;
    std::optional<FirstActions> first_actions_;  // none if dead methods are not to be skipped
    std::optional<StubbornSet> stubborn_set_;
    std::optional<RelevantFacts> relevant_facts_;
    std::optional<ReducedStates> reduced_states_;
    OrderedTasks ordered_tasks_;
    std::vector<Occurrence> unconstrained_;
    // Of the node looked at: the task to decompose, if there is one; the methods or else the actions to try.
    std::optional<Occurrence> compound_;
    std::vector<MethodId> live_methods_;
    std::vector<Occurrence> to_execute_;
    StateBits next_;
    bool waits_until_due_;
    std::uint64_t work_ = 0;  // of looking at networks
};

}  // namespace relax

#endif
