#ifndef RELAX_POLICIES_CUT_SOURCE_HPP
#define RELAX_POLICIES_CUT_SOURCE_HPP

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "relax/policies/disutility_terms.hpp"
#include "relax/policies/remembering_source.hpp"

namespace relax {

// Agents whose disutility of the total cost is a sum of a line and exponentials, of positive weights (one-switch and
// sums of exponentials): what they have spent matters to them, whatever it is. It is remembered up to a cut. A node is
// a state and a network, and
//
// - what is left until the cut: worth the expected disutility of the total cost; or
// - beyond the cut, one of the terms: worth that term of the cost to come alone, which does not depend on what was
//   spent (disutility_terms.hpp). What leads beyond the cut leads to the nodes of all terms, weighed by what was spent.
//
// Worths are logarithms (Recursion::LogExpected, or Seeking where the terms are).
//
// The best worths of this graph are lower worths. Beyond the cut each term is as small as some policy makes it, and no
// policy makes their weighted sum smaller than the sum of these: the ideal point. Up to the cut, that is carried back
// by a monotone recursion.
//
// The policy that comes with them follows, beyond the cut, the one of the first term. Its value is not worked out here:
// it is that of its runs, an upper value. With the first term the one of the largest slope A, the two meet as the cut
// grows. They differ by what the other terms are worth beyond the cut, which is at most a multiple of e^(A' s) for the
// next slope A' < A where s was spent (the nodes of the first term's policy being finitely many). If A is positive, the
// first term of this policy is what it is in this graph, so that E e^(A C) is at most a multiple of the best worth,
// whatever the cut; hence it spends s or more with a probability of at most a multiple of e^(-A s). Together that is
// e^((A' - A) s), which goes to 0. If A is not positive, e^(A' s) does so by itself.
//
// Where nothing is remembered, a search begins beyond the cut, once with each term: the sum of their worths is the
// ideal point of all policies. Agents who heed no cost on the way need fewer decisions.
class CutSource : public RememberingSource {
public:
    // A term of the disutility, with what every action is worth by it alone: certainty equivalents in the unit of
    // costs, and the same as prices, in units, for bounds.
    struct PricedTerm {
        DisutilityTerm term;
        StepAmounts amounts;
        const PricedProblem* priced;
        double unit;
    };
    struct Costs {
        double step;              // of the laws, in the unit of costs
        double failure = kNever;  // what giving up adds to what was spent, in the unit of costs; kNever: one may not
    };

    // Throws Stopped.
    CutSource(PolicyProgression& progression, std::vector<double> probabilities, const CostLaws& laws,
              const Costs& costs, const std::vector<PricedTerm>& terms, const HeuristicInfo& heuristic, Limits& limits);

    // What may be spent before it is forgotten, in steps; from 0 on.
    void set_cut(AmountLeft cut);
    // Begin beyond the cut, with a term: what it is worth by itself.
    void begin_beyond(std::size_t term) { root_ = beyond(term); }
    // What is left until the present cut, of what a node has as that; none beyond it.
    std::optional<AmountLeft> left_of(AmountLeft left) const {
        return is_beyond(left) ? std::nullopt : std::optional(left - base_);
    }

    PolicyNodeId add_root(DecisionGraph& graph) override;
    double bound(PolicyNodeId node, double known) override;

private:
    // The nodes beyond the cut have as what is left the number of their term, from kSpent on. They serve every cut; the
    // others differ from cut to cut, by a number that is added to what is left.
    static AmountLeft beyond(std::size_t term) { return kSpent + static_cast<AmountLeft>(term); }
    static std::size_t term_of(AmountLeft left) { return static_cast<std::size_t>(left - kSpent); }

    void draft(DecisionGraph& graph, AmountLeft left, const PolicyDecision& decision, DraftDecision& draft) override;
    void draft_term(DecisionGraph& graph, std::size_t term, const PolicyDecision& decision, DraftDecision& draft);
    void lead_beyond(DecisionGraph& graph, double left, const PolicyOutcome& outcome, const Law& law, double p,
                     DraftDecision& draft);
    PolicyNodeId add(DecisionGraph& graph, StateId state, NetworkId network, AmountLeft left);
    double worth(std::size_t term, double cost) const { return sign_ * terms_[term].log_at(cost); }
    double spent(double left) const { return (cut_ - (left - base_)) * costs_.step; }
    template <typename CostOf>
    double lower(AmountLeft left, CostOf cost_of) const;
    double stop(AmountLeft left) const;

    Costs costs_;
    double sign_;  // of logarithms as worths
    std::vector<DisutilityTerm> terms_;
    std::vector<StepAmounts> amounts_;  // by term
    std::vector<double> units_;
    std::vector<std::unique_ptr<PairBounds>> bounds_;
    AmountLeft cut_ = 0;                      // the present one; `base_` is its own
    AmountLeft next_base_ = 0;                // larger than all that is left
    std::map<AmountLeft, AmountLeft> bases_;  // by cut
    AmountLeft root_ = 0;
};

}  // namespace relax

#endif
