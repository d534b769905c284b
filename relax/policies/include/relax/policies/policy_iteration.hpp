#ifndef RELAX_POLICIES_POLICY_ITERATION_HPP
#define RELAX_POLICIES_POLICY_ITERATION_HPP

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "relax/base/limits.hpp"
#include "relax/policies/envelope.hpp"
#include "relax/policies/policy_evaluation.hpp"
#include "relax/policies/recursion.hpp"
#include "relax/policies/sure_region.hpp"

namespace relax {

// The best policy of an envelope, what is outside being worth what it is (Howard 1960). It begins with a policy that is
// proper (a run ends with probability 1, where it is wanted) and, for averse agents, finite; and each time a node
// changes its choice, or its worth, the worth falls. Hence:
//
// - The worths W satisfy W >= T_pi W for the policy pi of the moment. They do so after an evaluation, with equality. If
//   W(n) is replaced by the smaller worth of a decision that n takes from then on, it holds of n with equality, and of
//   all others since T is monotone. So all worths stay above those of pi, which stay above the best ones.
//
// - The policy stays proper, also where loops cost nothing. Suppose that pi had a closed set of nodes, strongly
//   connected, from which no end is reached, and look at the last time that a worth in it fell, that of m. Expected:
//   W >= T_pi W, averaged over the stationary distribution of the set, says that the steps in it cost nothing and that
//   W = T_pi W; so W is the same everywhere in the set (a maximum principle). A node k of the set other than m that may
//   lead to m had this worth before, too, and the same choice, but then W(k) < (T_pi W)(k), against what was shown. If
//   there is no k, then m leads to itself alone and its worth did not fall. Seeking: the same, since
//   e^-W <= Q e^-W with rows of Q that sum to at most 1. So pi was not proper before; but it was at the beginning.
//
// - The policy of an averse agent, or of one of a sum of exponentials, stays finite. On a strongly connected set, W >=
// ln (Q e^W + b) with b >= 0 says that the
//   spectral radius of Q is at most 1, and it is 1 only if b = 0 and e^W = Q e^W (Perron and Frobenius); the latter is
//   refuted as before.
//
// - It ends, since a policy never comes again, and the worths W at its end satisfy W <= T W: no policy that is proper
//   (and finite) has smaller ones. For W <= T_pi W, applied again and again, says that W is below what pi has cost
//   after so many steps plus the expected W where it is then; the latter goes to what is at the end.
//
// All this is done component by component, of the graph of all decisions, those first that others lead to (as in the
// topological value iteration of Dai and Goldsmith 2007). What a component leads to is settled by then, and given: its
// worths have only fallen, so that W >= T_pi W still holds in the component, and the above holds of it alone. A node
// that is in no loop takes its best decision, and that is all.
//
// An averse agent's finite policy to begin with. Let what is at the end be worth nothing at all (e^W = 0) and stopping
// anywhere 1, and improve the policy that stops everywhere. Where e^W = 0 at the end, a finite policy was found that
// does not stop. Elsewhere there is none: v = e^W satisfies v <= Q v for every decision and v = 0 at the ends, so that
// with w any worth that is known from below, w + c v is one for all c (the dual of the linear programme of Denardo and
// Rothblum 1979).
class PolicyIteration {
public:
    explicit PolicyIteration(Limits& limits) : limits_(limits), evaluation_(limits), sure_region_(limits) {}

    // Find the envelope's best policy and worths, from its choices. Throws Stopped, and leaves the envelope undefined.
    void improve(Envelope& envelope, Recursion kind);
    // After that, by an expected worth: find the policy of least expected cost of those that are worth as much, and
    // what each node costs by it. Runs end, free of cost, where stopping is worth as much as anything else. Throws
    // Stopped.
    //
    // Only decisions d with T_d W = W (to `kTieTolerance`) are left, and from a proper policy that takes them all
    // others that are found are proper, too, as said above. A proper policy pi that takes them has W = T_pi W, and is
    // worth W.
    void break_ties(Envelope& envelope, Recursion kind, const SegmentedArray<double>* outside);

    // Whether some node has a proper policy and no finite one; or perhaps has none, for all that floating point can
    // tell.
    bool found_infinite() const { return found_infinite_; }
    bool is_undecided() const { return is_undecided_; }
    // How many times a place was improved or evaluated so far: what all this took.
    std::uint64_t visited() const { return visited_; }

private:
    void start_finite(Envelope& envelope, Recursion kind);
    void note_near(const Envelope& envelope, const std::vector<bool>& is_sure);
    bool spread_near(const Envelope& envelope, const std::vector<bool>& is_near, std::vector<bool>& leaves);
    void stop_where_infinite(Envelope& envelope, Recursion kind);
    void iterate(Envelope& envelope, Recursion kind);
    void iterate(Envelope& envelope, Recursion kind, std::uint32_t first, std::uint32_t end);
    bool sweep(Envelope& envelope, Recursion kind, std::uint32_t first, std::uint32_t end);
    bool choose_best(Envelope& envelope, Recursion kind, std::uint32_t place);

    Limits& limits_;
    PolicyEvaluation evaluation_;
    SureRegion sure_region_;
    std::vector<double> before_;  // by place of a component: worths before a round
    std::uint64_t visited_ = 0;
    bool found_infinite_ = false;
    bool is_undecided_ = false;
};

// How much of itself, or of 1 if that is more, a worth must fall by to count.
inline constexpr double kWorthTolerance = 1e-13;

// Decisions are as good as the best one if they are worse by no more than this part of the worth, or of 1.
inline constexpr double kTieTolerance = 1e-12;

inline double slack_of(double worth) { return kWorthTolerance * std::max(1.0, std::abs(worth)); }

}  // namespace relax

#endif
