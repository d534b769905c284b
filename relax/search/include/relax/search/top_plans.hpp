#ifndef RELAX_SEARCH_TOP_PLANS_HPP
#define RELAX_SEARCH_TOP_PLANS_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "relax/analysis/prices.hpp"
#include "relax/base/id_table.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/heuristics/heuristic.hpp"
#include "relax/problem/ground_problem.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/action_lists.hpp"
#include "relax/search/open_list.hpp"
#include "relax/search/search_options.hpp"
#include "relax/search/search_result.hpp"

namespace relax {

// When two plans are different: as sequences of actions, or by which actions they have and how many of each.
enum class Distinct : std::uint8_t { Sequence, Multiset };

struct TopPlansOptions {
    std::size_t count = 1;  // of plans that are wanted
    Distinct distinct = Distinct::Sequence;
    bool limits_ways = true;  // keep no more than so many ways to a pair of state and network
    // Of these it reads the heuristic, which must be admissible, and those that FindPlans shares with other searches:
    // use_tdg_bound, inherit_h, skip_dead_methods, forget_facts, and for multisets use_stubborn_sets.
    SearchOptions search;
};

struct TopPlansStatistics : SearchStatistics {  // `lower_bound` is that of all plans that are not among those found
    std::size_t found = 0;
    std::size_t proven = 0;  // the first so many of them are the best there are
};

struct TopPlansResult {
    std::optional<StopReason> stop;  // why the search ended before it was done
    bool is_all = false;             // there are no other plans
    TopPlansStatistics statistics;
    std::vector<SearchResult> plans;  // the cheapest first; of each its cost, decomposition and plan
};

// The cheapest plans that differ in their actions: A* over states, task networks and the actions so far.
//
// Actions of the domain have labels; those that stand for preconditions have none and do not count, nor do different
// decompositions. A node is a pair of state and network, and a way to it: the list of the labels on it, as a sequence
// or as a multiset. Two paths to a pair with the same list are the same way, at the lower cost of the two (only
// multisets can have two costs, where those depend on the state). Every way has its own g, all ways to a pair have one
// h.
//
// Of each pair only the k cheapest ways are kept: what completes a dearer one to a plan completes each of those to
// another plan, different and not dearer. So there are finitely many nodes where there are finitely many pairs,
// whatever loops cost nothing. By the same argument every plan that is cheaper than both the k-th plan found and the
// least f of all open nodes has been found: else take the cheapest plan that was not, with the fewest steps to go from
// a node on its path that was kept and expanded. The next node was generated, and is not open, since its f is too low;
// so it is kept and expanded, against the choice, or k others were preferred to it. These, completed likewise, are k
// plans as cheap as it is: not all were found, and one that was not has fewer steps to go.
//
// The order of actions makes no difference between multisets: there stubborn sets are allowed (moving an action to the
// front changes neither its own case nor that of another, so that the cost stays the same), and executing an action at
// once that costs and changes nothing. Between sequences it does: there only actions without a label come at once.
class TopPlans {
public:
    // `labels`: by ActionId. `statistics` is kept up to date for whoever watches from
    // `limits.poll`. Throws Stopped.
    TopPlans(const GroundProblem& problem, Prices prices, std::vector<std::optional<ActionLabel>> labels,
             const TopPlansOptions& options, Limits& limits, TopPlansStatistics& statistics);

    TopPlansResult run();

private:
    using PairId = std::uint32_t;
    using WayId = NodeId;  // as the open list calls it

    // A state and a network, and all ways to it that are kept.
    struct Pair {
        StateId state;
        NetworkId network;
        Cost h;                   // a lower bound of the cost to come
        bool is_evaluated;        // `h` includes the heuristic
        std::vector<WayId> ways;  // a heap, the dearest first
    };
    struct Way {
        Cost g;
        PairId pair;
        ActionListId actions;
        WayId parent;  // itself for the root
        SearchStep step;
        bool is_kept;
        bool is_expanded;  // at its present g
    };

    std::optional<StopReason> search();
    bool evaluate(Pair& pair);
    void expand(WayId id);
    void generate(WayId parent, const Successor& successor);
    void add_plan(WayId id);
    bool keep(WayId id);
    ActionListId list_after(WayId way, const SearchStep& step);
    Cost cheap_bound(const Pair& parent, const Successor& successor);
    PairId find_pair(StateId state, NetworkId network);
    std::optional<WayId> find_way(PairId pair, ActionListId actions) const;
    WayId add_way(const Way& way);
    Cost priority(const Way& way) const { return way.g + pairs_[way.pair].h; }
    Cost enough() const;
    void note_proven(Cost bound);
    void push(WayId id);
    bool is_cheaper(WayId left, WayId right) const;
    SearchResult trace(WayId goal);

    const GroundProblem& problem_;
    Prices prices_;
    std::vector<std::optional<ActionLabel>> labels_;
    TopPlansOptions options_;
    Limits& limits_;
    TopPlansStatistics& statistics_;
    Progression progression_;
    std::unique_ptr<Heuristic> heuristic_;
    ActionLists lists_;
    SegmentedArray<Pair> pairs_;
    IdTable pair_table_;
    SegmentedArray<Way> ways_;
    IdTable way_table_;
    OpenList open_;
    std::vector<WayId> plans_;  // the cheapest that were found, the cheapest first
    bool leaves_out_ = false;   // there may be more than those ...
    bool is_cut_ = false;       // ... that cost `kMostCost` or more
    std::vector<Successor> successors_;
    std::vector<TaskId> tasks_;
};

// Make and run it; a limit that is reached while it is being made is a result, too.
TopPlansResult top_plans(const GroundProblem& problem, Prices prices, std::vector<std::optional<ActionLabel>> labels,
                         const TopPlansOptions& options, Limits& limits, TopPlansStatistics& statistics);

}  // namespace relax

#endif
