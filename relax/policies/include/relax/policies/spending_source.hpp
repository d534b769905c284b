#ifndef RELAX_POLICIES_SPENDING_SOURCE_HPP
#define RELAX_POLICIES_SPENDING_SOURCE_HPP

#include <cstdint>
#include <vector>

#include "relax/policies/remembering_source.hpp"

namespace relax {

// The disutility of what is left of an amount, in steps of a grid: given for what is left, and linear in what is spent
// beyond it, as it is in what is left beyond what is given.
struct DisutilityLeft {
    std::vector<double> of_left;  // by what is left, from 0 on
    double gain = 0;              // by so much it falls for each step that is left beyond the last of these
    double beyond = 0;            // of the smallest excess, but for ...
    double slope = 0;             // ... this for each step; 0: all of them are equally bad

    double of(double left) const {
        if (left < 0) {
            return beyond - slope * left;
        }
        const double last = static_cast<double>(of_left.size() - 1);
        return left <= last ? of_left[static_cast<std::size_t>(left)] : of_left.back() - gain * (left - last);
    }
};

// Agents who mind what they have spent, by an expected disutility of what is left of an amount in the end. A node is a
// state, a network and what is left, so that one graph serves every amount to begin with.
//
// What is spent beyond the amount is paid at once, by the slope; the agent is neutral from there on: nodes there are
// worth the expected cost to come, times the slope. Where the slope is 0, all that comes then is equally bad. The agent
// then follows the policy of least expected cost: nodes are worth that, and what leads to them has the weight 0. They
// are searched all the same, since an agent that must be done must be able to be done from there.
//
// `Worths::failure`: what giving up adds to what was spent, in steps; kNever where one may not. If that is infinite and
// allowed, to have spent more than the amount is as bad as to have failed: nodes there are ends.
class SpendingSource : public RememberingSource {
public:
    enum class GivingUp : std::uint8_t { No, AtACost, AsBadAsLate };
    struct Worths {
        DisutilityLeft disutility;
        GivingUp giving_up = GivingUp::No;
        double failure = 0;  // in steps
    };

    // `least`: the least costs as prices in steps; `means`: the means in units, of which a step has `units_per_step`.
    // Throws Stopped.
    SpendingSource(PolicyProgression& progression, std::vector<double> probabilities, const CostLaws& laws,
                   const Worths& worths, const PricedProblem& least, const PricedProblem& means, double units_per_step,
                   const HeuristicInfo& heuristic, Limits& limits);

    // What is left to begin with, in steps.
    void begin_with(AmountLeft left) { first_ = left; }

    PolicyNodeId add_root(DecisionGraph& graph) override;
    double bound(PolicyNodeId node, double known) override;

private:
    void draft(DecisionGraph& graph, AmountLeft left, const PolicyDecision& decision, DraftDecision& draft) override;
    void draft_spent(DecisionGraph& graph, const PolicyDecision& decision, DraftDecision& draft);
    PolicyNodeId add(DecisionGraph& graph, StateId state, NetworkId network, AmountLeft left);
    double lower(AmountLeft left, Cost least, Cost mean) const;
    double stop(AmountLeft left) const;
    // Of a spent node per step: the slope, or 1 where its worth does not matter to others.
    double scale() const { return worths_.disutility.slope > 0 ? worths_.disutility.slope : 1; }

    Worths worths_;
    double mean_step_;  // in steps, of a unit of the means
    PairBounds least_;
    PairBounds means_;
    AmountLeft first_ = 0;
};

}  // namespace relax

#endif
