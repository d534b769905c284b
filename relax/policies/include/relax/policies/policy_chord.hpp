#ifndef RELAX_POLICIES_POLICY_CHORD_HPP
#define RELAX_POLICIES_POLICY_CHORD_HPP

#include <optional>

#include "relax/base/limits.hpp"
#include "relax/policies/decision_graph.hpp"
#include "relax/policies/network_source.hpp"
#include "relax/policies/policy_search.hpp"
#include "relax/progression/step_amounts.hpp"

namespace relax {

struct Chord {
    double at_low;
    double at_high;
};

// An interval of x = 1 / alpha, and for each action and part of a cost a line that is below its certainty equivalent
// on the interval, by its values at both ends. All in the domain's unit of cost.
struct ChordPrices {
    StepAmounts at_low;
    StepAmounts at_high;
    double low;       // at least 0
    double high;      // above it, and at most `explored`
    double touching;  // where the chord is to be near the best certainty equivalent; in the interval, above 0
    double explored;  // x of the averse agent whose search it is
    Chord enough;     // no more is needed
};

// A line below the certainty equivalents of all policies on an interval of x, from what an averse agent's search has
// explored.
//
// For a policy let P be the law of its runs, C their cost and f(x) = x ln E e^(C/x). For every law Q of runs
//
//     f(x) >= E_Q C - x KL(Q | P)
//
// (Donsker and Varadhan 1975), with equality where Q has the density e^(C/x) but for a factor. Let one transition law
// q_d be given for every decision d, whatever the policy is, and let Q be made of these. Then the right side is a sum
// over the steps of runs of Q: of sum_i q_d(i) c_i - x KL(q_d | p_d). It is a line in x; and so it is where each cost
// that is uncertain by itself counts by a line below its certainty equivalent. At both ends of the interval the least
// such sum of any policy is what a Markov decision process with expected costs is worth: m and n. Every policy's line
// is at least m and n there, and thus nowhere below their chord.
//
// q_d is the law that the best policy's agent sees at the touching point: p_d(i) e^((c_i + W_i) / x), where W are the
// best certainty equivalents there. With it no decision's sum is below W at that point, by the very equation that W
// satisfies: there the chord's process is worth W, and the error of the chord is quadratic in the width of the interval
// for policies that are near the best. Another W would make it no less sound.
//
// Nodes that are open count as ends that are worth their lower worths: those of the agent of x = `explored`, who minds
// long runs least, so that they are below the certainty equivalents of all x of the interval. Nodes from which this
// agent has no finite policy have none on the interval. Where a policy of one of the ends meets open nodes, and the
// chord is not enough, more is explored from these on: the agent's own search leaves alone what is as good as its best
// policy.
//
// Sums of steps may be negative, so that policy iteration may end up with a policy that is not proper; then there is no
// chord (nor where nothing is finite at the touching point). Otherwise its worths L satisfy L <= T_d L for all
// decisions. Applied again and again that says that L is at most the sum of any stationary policy that is proper, since
// what is left of L after many steps goes to nothing: q_d is kept above a small part of p_d, so that a policy that is
// proper by p is proper by q. And the best certainty equivalent is that of stationary policies.
//
// `search`: of that agent, over `source`; it has a root. Throws Stopped.
std::optional<Chord> chord_below(PlanningSource& source, PolicySearch& search, const ChordPrices& prices,
                                 Limits& limits);

}  // namespace relax

#endif
