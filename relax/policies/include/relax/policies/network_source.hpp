#ifndef RELAX_POLICIES_NETWORK_SOURCE_HPP
#define RELAX_POLICIES_NETWORK_SOURCE_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/limits.hpp"
#include "relax/policies/decision_source.hpp"
#include "relax/policies/network_nodes.hpp"
#include "relax/policies/recursion.hpp"
#include "relax/progression/policy_progression.hpp"
#include "relax/progression/step_amounts.hpp"

namespace relax {

// An outcome of a decision, and the branch of the graph that it is: of what remembers an amount spent, the same outcome
// has a branch for each amount.
struct TracedBranch {
    double probability;
    std::optional<ActionId> action;
    std::span<const CostPartId> due_parts;
    PolicyNodeId successor;
};

// A step of the agent's, where it is taken. But for the first one of a decision, also the action that led there, if
// any.
struct TracedStep {
    StateId state;
    NetworkId network;
    SearchStep step;
    std::optional<ActionId> before;
};

// A source whose nodes are states and networks.
//
// A decision goes on through all that must come after it: where it decomposes a task, or executes an action that costs
// and changes nothing, and a single decision is left then, that one is taken, too. States and networks on the way are
// no nodes. They would be worth what the decision is worth; and to give up there is to give up before it.
class PlanningSource : public DecisionSource {
public:
    // `probabilities`: by ActionId, of outcome actions; 1 for others.
    PlanningSource(PolicyProgression& progression, std::vector<double> probabilities)
        : progression_(progression), nodes_(progression), probabilities_(std::move(probabilities)) {}

    // Whether decisions go on through what must come after them; before there is a node.
    void set_follows_forced(bool follows_forced) { follows_forced_ = follows_forced; }

    const NetworkNodes& nodes() const { return nodes_; }
    PairId pair_of(StateId state, NetworkId network) { return nodes_.pair_of(state, network); }
    PolicyProgression& progression() { return progression_; }

    // The steps of a decision of an expanded node, and what may come of the last one; valid until the next call. Throws
    // Stopped.
    struct Traced {
        std::span<const TracedStep> steps;
        std::span<const TracedBranch> branches;
    };
    Traced trace(PolicyNodeId node, std::uint32_t decision);
    // Call `put(branches)` with what may come of each decision of an expanded node, in the order of the graph.
    template <typename Put>
    void trace_all(PolicyNodeId node, Put put) {
        find_decisions(node);
        for (PolicyDecision& decision : decisions_) {
            follow(decision, nullptr);
            branches_.clear();
            list_branches(nodes_[node].left, decision, branches_);
            put(std::span<const TracedBranch>(branches_));
        }
    }

    void decide(DecisionGraph& graph, PolicyNodeId node, std::vector<DraftDecision>& drafts) final;

protected:
    // Say what a decision leads to from a node with so much left. `draft` is empty, with the constant 0.
    virtual void draft(DecisionGraph& graph, AmountLeft left, const PolicyDecision& decision, DraftDecision& draft) = 0;
    // Call `put(probability, outcome, successor)` for each branch of a decision, always in the same order.
    virtual void list_branches(AmountLeft left, const PolicyDecision& decision,
                               std::vector<TracedBranch>& branches) = 0;

    double probability(const PolicyOutcome& outcome) const {
        return outcome.action ? probabilities_[*outcome.action] : 1.0;
    }
    PolicyProgression& progression_;
    NetworkNodes nodes_;

private:
    void find_decisions(PolicyNodeId node);
    void follow(PolicyDecision& decision, std::vector<TracedStep>* steps);

    std::vector<double> probabilities_;
    bool follows_forced_ = true;
    std::vector<PolicyDecision> decisions_;
    bool heeds_costs_ = true;  // at the node of these: what is left matters there
    std::vector<PolicyDecision> next_;
    std::vector<TracedStep> steps_;
    std::vector<TracedBranch> branches_;
};

// Agents who do not mind what they have spent: neutral and exponential ones, and those that want to be done.
class NetworkSource : public PlanningSource {
public:
    struct Worths {
        Recursion recursion = Recursion::Expected;
        double stop = kNever;  // what it is worth to give up
        double unit = 1;       // the worth of a unit of the prices for bounds; 0: they tell dead ends alone
    };

    // `amounts`: what is added to the constant of a decision, or to the weight of an outcome; `costs`: what is
    // expected. Throws Stopped.
    NetworkSource(PolicyProgression& progression, std::vector<double> probabilities, const StepAmounts& amounts,
                  const StepAmounts& costs, const Worths& worths, const PricedProblem& priced,
                  const HeuristicInfo& heuristic, Limits& limits);

    PolicyNodeId add_root(DecisionGraph& graph) override;
    double bound(PolicyNodeId node, double known) override;

private:
    void draft(DecisionGraph& graph, AmountLeft left, const PolicyDecision& decision, DraftDecision& draft) override;
    void list_branches(AmountLeft left, const PolicyDecision& decision, std::vector<TracedBranch>& branches) override;
    PolicyNodeId add(DecisionGraph& graph, StateId state, NetworkId network);
    double worth_of(Cost bound) const {
        return bound >= kInfinity ? kNever : worths_.unit * static_cast<double>(bound);
    }

    StepAmounts amounts_;
    StepAmounts costs_;
    Worths worths_;
    PairBounds bounds_;
};

}  // namespace relax

#endif
