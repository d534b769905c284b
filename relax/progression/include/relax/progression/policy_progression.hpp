#ifndef RELAX_PROGRESSION_POLICY_PROGRESSION_HPP
#define RELAX_PROGRESSION_POLICY_PROGRESSION_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/networks/node_view.hpp"
#include "relax/networks/task_network.hpp"
#include "relax/problem/state.hpp"
#include "relax/progression/progression.hpp"

namespace relax {

// What may come of a decision. The agent sees which it is, by the action.
struct PolicyOutcome {
    StateId state;
    NetworkId network;
    std::optional<ActionId> action;     // the ordinary or the outcome action that was executed; none: decomposed
    std::vector<CostPartId> due_parts;  // of its cost
};

// A task decomposed by a method, or an action executed (no method). An ordinary action, and a task decomposed, has one
// outcome; a chance task one for each of its methods, in their order.
struct PolicyDecision {
    SearchStep step;
    std::vector<PolicyOutcome> outcomes;
};

// Which actions and parts of costs are uncertain where the agent sees what it has spent. Both empty: it does not, or
// it does not care.
struct SeenCosts {
    std::vector<bool> actions;  // by ActionId
    std::vector<bool> parts;    // by CostPartId
};

struct PolicySwitches {
    bool skip_dead_methods = true;  // as in ProgressionSwitches, all of them
    bool stubborn_sets = true;
    bool forget_facts = true;
    bool forget_unreachable = true;  // states keep only the facts that actions read which are still within reach
    bool lone_members = true;        // rule (3) below, with stubborn sets
};

struct PolicyOptions : PolicySwitches {
    // What a run has cost that is not done does not matter: it makes the policy worthless, or is as bad as it can be.
    bool only_done_runs_pay = false;
};

// What an agent may do in a state with a task network, where actions have several outcomes: the decisions among which
// there is a best one. Knows nothing of probabilities and prices. No macro-actions: networks are merged only where they
// are equal.
//
// Every task that is unconstrained may come next: an applicable action is executed, a compound task decomposed.
// Progression takes fewer; that is wrong here, since the choice of a method may wait for what comes of an action
// elsewhere. What is seen of a step is what nature chooses: an outcome, or, where the agent sees what it has spent, a
// cost. Call a task *uncertain* if it is a chance task or an action with an uncertain cost that is seen, or may lead to
// one.
//
// Of the tasks of a network let S be some that are unconstrained, R those outside S that are not ordered after a member
// of S, and nothing of R uncertain. Decisions for members of S are enough where S is
//
// (1) one compound task, by all of its methods, or
// (2) a stubborn set of actions (StubbornSet), by those that are applicable; chance tasks may be among them. If none
// is,
//     nothing is left to try.
//
// Proof. Take a policy. What it does before it comes to a member b of S is of R, so that nothing is seen meanwhile: it
// is one sequence of steps. If it never comes to one, it is never done, and stopping at once costs no more. Otherwise
// let it begin with b instead and then, whatever came of that, go through the same sequence, and on as before. For (1)
// this is possible because decomposing reads nothing and only takes constraints away. For (2), b is applicable now and
// commutes with what came before it, as the proof of StubbornSet says, for each of its outcomes: a chance task reads
// and makes what all of its outcomes do. The new policy runs into the same states at the same total costs with the same
// probabilities; where it stops sooner, by its own decision, it has paid no more. So it is worth as much to every agent
// that minds nothing but what was spent in total and whether it was done.
//
// Where R may be uncertain, let S be a stubborn set of actions of which at most one, b, is applicable.
//
// (3) If none is, nothing is left to try. If b is, it is enough where only runs that are done have to pay.
//
// Proof. Before a run comes to a member of S, it executes actions of R, so that by the second condition of StubbornSet
// the other members stay inapplicable: every run that is done executes b first of S, and none is done if there is no b.
// Let the policy begin with b and then go on as it would have without it, but for b itself; what it has seen of b it
// heeds only where it comes to b. It can, since b commutes with all that comes before it, for each of its outcomes.
// Runs that are done come to the same states at the same total costs with the same probabilities. Others may have paid
// for b in vain, which does not matter. (With a price of failure it would: an agent that gives up because of what it
// has seen elsewhere need not have paid for b.)
//
// Always first: an action that costs and changes nothing, and is applicable, is executed at once, and a compound task
// with one method is decomposed at once. Every policy that is done does so at some time; doing it now takes constraints
// away, costs nothing and shows nothing, so that the policy can go on as if it had not been done, and skip it later.
class PolicyProgression {
public:
    // All that makes states or networks may throw Stopped.
    //
    // `free_actions`: by ActionId, those that certainly cost nothing.
    PolicyProgression(const AnalysedProblem& problem, const std::vector<bool>& free_actions, const SeenCosts& seen,
                      const PolicyOptions& options, Limits& limits);

    StateId initial_state() { return progression_.initial_state(); }
    NetworkId initial_network() { return progression_.initial_network(); }
    // Replace the content of `decisions` by those of a node. None: nothing is left to try, or all is done.
    //
    // `heeds_costs`: whether the agent, who may see costs, still heeds them; from where it does not, costs are as if
    // they were not seen, and fewer decisions are enough.
    void decisions(StateId state, NetworkId network, std::vector<PolicyDecision>& decisions, bool heeds_costs = true);
    // Whether nothing was executed, or an action that certainly costs nothing and changes nothing.
    bool costs_and_changes_nothing(const PolicyOutcome& outcome) const {
        return !outcome.action || progression_.is_executed_at_once(task_of(*outcome.action));
    }
    // Whether all is done: the network is empty. (The goal is an action of the network.)
    bool is_done(NetworkId network) { return progression_.networks().is_empty(network); }

    // As of Progression.
    NodeView view(StateId state, NetworkId network) { return progression_.view(state, network); }
    StateBits facts_that_matter(StateId state, NetworkId network) {
        return progression_.facts_that_matter(state, network);
    }
    const OrderedTasks& ordered_tasks(NetworkId network) { return progression_.ordered_tasks(network); }
    const StateRegistry& states() const { return progression_.states(); }
    TaskNetworks& networks() { return progression_.networks(); }

private:
    // What is uncertain, by TaskId, and stubborn sets by that.
    struct Branching {
        std::vector<bool> is_uncertain;
        std::optional<StubbornSet> stubborn_set;
    };

    // An ordinary action or a chance task.
    bool is_action(TaskId task) const { return problem_.is_primitive(task) || problem_.is_chance(task); }
    bool is_applicable(const Occurrence& occurrence, StateId state) const {
        return transition_.is_applicable(problem_.any_outcome(occurrence.task), progression_.states()[state]);
    }
    bool is_first(const Occurrence& occurrence, StateId state) const;
    void choose(StateId state, NetworkId network);
    bool choose_lone_member(StateId state, const OrderedTasks& ordered);
    void find_uncertain(const OrderedTasks& ordered);
    std::optional<Occurrence> compound_to_decompose(const OrderedTasks& ordered) const;
    void add_decisions(StateId state, NetworkId network, const Occurrence& occurrence,
                       std::vector<PolicyDecision>& decisions);

    const AnalysedProblem& problem_;
    StateTransition transition_;
    Progression progression_;
    Branching heeding_;
    std::optional<Branching> heedless_;  // where costs are seen at all
    bool uses_lone_members_;
    bool only_done_runs_pay_;
    // Of the node looked at.
    Branching* branching_ = &heeding_;
    std::vector<Occurrence> unconstrained_;
    std::vector<Occurrence> chosen_;
    std::vector<MethodId> methods_;
    std::vector<std::uint32_t> uncertain_;  // occurrences
};

}  // namespace relax

#endif
