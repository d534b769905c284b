#ifndef RELAX_POLICIES_POLICY_SEARCH_HPP
#define RELAX_POLICIES_POLICY_SEARCH_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/policies/decision_graph.hpp"
#include "relax/policies/decision_source.hpp"
#include "relax/policies/envelope.hpp"
#include "relax/policies/policy_iteration.hpp"
#include "relax/policies/recursion.hpp"

namespace relax {

struct PolicySearchOptions {
    Recursion recursion = Recursion::Expected;
    double precision = 1e-6;   // of the worth: upper and lower worth may differ by so much of the larger, or of 1
    double unit = 1;           // by which worths are multiplied to be values, for the precision
    bool breaks_ties = false;  // of the best policies find that of least expected cost; worths are expected ones
};

struct PolicyStatistics {
    std::size_t expanded = 0;
    std::size_t generated = 0;
    std::size_t evaluated = 0;   // nodes that the source was asked to look closer at
    std::size_t dead_ends = 0;   // nodes that are worth kNever as soon as they are looked at
    std::size_t rounds = 0;      // through the best policy by the lower worths
    std::size_t iterations = 0;  // improvements of policies
    double lower = 0;            // the worth of every policy is at least this ...
    double upper = kNever;       // ... and that of the best one found is at most this
    double cost = 0;             // where ties are broken: the expected cost of the best one found
};

// A policy: its nodes, of which the first is the root, and what it chooses at each of them.
struct FoundPolicy {
    std::vector<PolicyNodeId> nodes;
    std::vector<DecisionId> choices;
};

struct PolicySearchResult {
    std::optional<StopReason> stop;  // why the search ended before it was done
    PolicyStatistics statistics;
    std::optional<FoundPolicy> policy;
    bool is_infinite = false;   // where nothing is worth anything: there are proper policies, but no finite one ...
    bool is_undecided = false;  // ... as far as floating point can tell
};

// LAO* (Hansen and Zilberstein 2001) in its improved form. Every node has a lower worth L and the decision that is best
// by it. A round goes depth-first through the policy that these make; it expands the open nodes that it meets, goes on
// below them as long as their worths do not rise, and backs up on its way back.
//
// Lower worths stay lower worths: those of new nodes are admissible, and if L <= V* then T L <= T V* = V*, since T is
// monotone.
//
// Where loops cost nothing, or an agent that seeks risk, or one without a proper policy, could wait for ever, backing
// up does not lead to V*. So, once a round has met no open node, the best policy of the envelope (the nodes of the
// rounds since then, or all that are explored if these are not many more) is found by policy iteration, nodes outside
// being worth L; V* restricted to the envelope is at least that. If that policy stays inside, it is worth what it was
// found to be, and so is the best of all. Nodes from which nothing can be reached become worth kNever. If it leaves the
// envelope, the nodes that it leads to are met in the next round: an open one, or they are added to the envelope. So it
// grows until one or the other comes; else two loops could refer to each other for ever.
//
// From time to time the best policy of all that is explored is found, open nodes being nodes to stop at: an upper
// worth. When the two are near enough, or a limit is reached, that is the result.
//
// Where ties are broken, nodes have a lower expected cost C, too, and take the decision that costs least by it of those
// that are best by L. C is a bound where L is exact: then a decision of the best policy is one of them, and L is exact
// at its successors, so that the least C over them is a bound, too. So C is found anew whenever L rises, and counts in
// the end, when the best policy stays in the envelope and is worth L.
class PolicySearch {
public:
    // `statistics` is kept up to date for whoever watches from `limits.poll`.
    PolicySearch(DecisionSource& source, const PolicySearchOptions& options, Limits& limits,
                 PolicyStatistics& statistics);

    // From the source's root of the moment. What was explored by earlier runs is used.
    PolicySearchResult run();

    // Of the runs to come.
    void set_precision(double precision) { options_.precision = precision; }

    const DecisionGraph& graph() const { return graph_; }
    // Of the last run, which was not ended before it had one.
    PolicyNodeId root() const { return root_; }
    // Explore more: the best policies by the lower worths from some nodes on, until these meet no open node, or for
    // some rounds. Throws Stopped.
    void explore_from(std::span<const PolicyNodeId> nodes);

private:
    static constexpr std::uint64_t kWalkedPerNode = 16;
    static constexpr std::uint64_t kFewNodes = 256;

    struct Frame {
        PolicyNodeId node;
        std::uint32_t next;  // outcome of the choice to go to
    };

    void search();
    bool explore();
    void enter(PolicyNodeId node, bool& has_met_open);
    void expand(PolicyNodeId node);
    bool back_up(PolicyNodeId node);
    bool back_up_cost(PolicyNodeId node, bool has_risen);
    void gather(PolicyNodeId node);
    bool improve_envelope();
    void expand_around();
    void list_open(PolicyNodeId node, std::vector<PolicyNodeId>& open);
    // Whether going through policies and improving them has taken more than expanding nodes. More nodes are expanded in
    // passing then, also such as the best policy by the lower worths may not need.
    bool hurries() const { return walked_ > kWalkedPerNode * (statistics_.expanded + kFewNodes); }
    void improve(Outside outside);
    void improve_explored();
    void note_costs();
    bool keep_if_closed(Outside outside);
    bool is_better(double worth, double cost) const;
    bool is_near() const;
    void note_lower();

    DecisionSource& source_;
    PolicySearchOptions options_;
    Limits& limits_;
    PolicyStatistics& statistics_;
    DecisionGraph graph_;
    PolicyNodeId root_;
    Envelope envelope_;
    PolicyIteration iteration_;
    PolicyEvaluation evaluation_;
    SegmentedArray<double> costs_;  // by node: C, where ties are broken
    std::vector<Frame> frames_;
    std::vector<PolicyNodeId> order_;     // nodes of the round, each after those that it leads to but for loops
    std::vector<PolicyNodeId> members_;   // of the envelope: nodes of all rounds since an open node was met
    std::vector<PolicyNodeId> explored_;  // expanded nodes
    std::vector<DraftDecision> drafts_;
    std::vector<double> worths_;  // by place of the envelope, while ties are broken
    std::uint32_t round_ = 0;
    std::uint32_t gathering_ = 1;         // the number of the envelope
    std::uint32_t quiet_rounds_ = 0;      // since an open node was met
    std::uint32_t quiet_iterations_ = 0;  // likewise
    std::uint64_t walked_ = 0;            // nodes that rounds and improvements have gone through so far
    std::size_t plunges_left_ = 0;        // of the round: nodes that may be expanded right after their parents
    bool has_changed_ = false;            // in the round: a choice
    std::size_t next_upper_ = 256;        // when so many nodes are expanded
    std::optional<FoundPolicy> best_;
};

}  // namespace relax

#endif
