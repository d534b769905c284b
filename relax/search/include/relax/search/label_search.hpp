#ifndef RELAX_SEARCH_LABEL_SEARCH_HPP
#define RELAX_SEARCH_LABEL_SEARCH_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/heuristics/selective_heuristic.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/action_lists.hpp"
#include "relax/search/label_edges.hpp"
#include "relax/search/label_space.hpp"
#include "relax/search/open_list.hpp"
#include "relax/search/search_options.hpp"
#include "relax/search/search_result.hpp"
#include "relax/valuations/valuation.hpp"

namespace relax {

struct LabelStatistics : SearchStatistics {  // `lower_bound`, of all plans that are not among those found: a Worth
    std::size_t found = 0;
    std::size_t proven = 0;  // the first so many of them are the best there are
};

struct LabelSearchResult {
    std::optional<StopReason> stop;  // why the search ended before it was done
    bool is_all = false;             // there are no other plans
    LabelStatistics statistics;
    std::vector<SearchResult> plans;  // the best first; of each the cost at the valuation's first prices
    std::vector<Worth> worths;        // of each plan
};

// A* over labels: the best plans, or the best ones that differ in their actions, by whatever a way has cost so far and
// is worth in the end (Valuation). Where that is a single number this is A* over nodes with the paths to them; where it
// is several numbers, or a law, it is multi-objective A* (Stewart and White 1991) with dominance as the objective
// allows.
//
// Actions of the domain have names; precondition actions have none and do not count, nor do different decompositions.
// A label is open until its bound is the least. Heuristics belong to nodes, one for each vector of prices: they are
// asked about the node of the label that is popped, one after the other, as long as its bound does not rise, and as
// long as that pays.
//
// A label's bound is at least its parent's: each completion of the label is one of the parent. It ends when no open
// label has a bound below what is still wanted; so the first plan, once nothing open is better, is the best there is.
//
// The order of actions makes no difference to sums: stubborn sets are allowed (moving an action to the front changes
// neither its own case nor that of another), but not where plans are sequences of actions that differ in their order.
class LabelSearch {
public:
    // `names`: by ActionId. The valuation has begun with the progression's networks. `statistics` is kept up to date
    // for whoever watches from `limits.poll`. Throws Stopped.
    LabelSearch(const AnalysedProblem& problem, Valuation& valuation, std::span<const std::optional<ActionName>> names,
                const LabelSearchOptions& options, Progression& progression, Limits& limits,
                LabelStatistics& statistics);

    // Search from the initial network, and put together what was found.
    LabelSearchResult run();

    struct Way {
        Worth worth;
        std::vector<SearchStep> steps;
    };
    // Search from the initial state and a network. Says why it was stopped; or throws Stopped.
    std::optional<StopReason> search(NetworkId from);
    // The best plan that was found, as the way to it.
    std::optional<Way> best() const;

private:
    bool keeps_bound(LabelId id);
    bool leaves_out_orders();
    bool asks_from_now_on();
    void ask(LabelSpace::Node& node);
    std::uint64_t work() const;
    void expand(LabelId id);
    void inherit(NodeId parent, const Edge& edge);
    void generate(LabelId parent, const Edge& edge);
    bool is_wanted(Worth bound);
    void add_plan(LabelId id);
    void note_proven(Worth bound);
    void count_proven();
    void push(LabelId id);
    ActionListId list_after(ActionListId before, ActionId action);
    std::vector<SearchStep> steps_to(LabelId goal) const;

    const AnalysedProblem& problem_;
    Valuation& valuation_;
    std::span<const std::optional<ActionName>> names_;
    LabelSearchOptions options_;
    Limits& limits_;
    LabelStatistics& statistics_;
    Progression& progression_;
    std::vector<SelectiveHeuristic> heuristics_;  // by price, once they are asked
    ActionLists lists_;
    LabelSpace labels_;
    LabelEdges edges_;
    OpenList<LabelId> open_;
    std::vector<LabelId> plans_;  // the best that were found, the best first
    Worth cutoff_;                // plans are wanted that are worth less
    bool has_pruned_ = false;     // there may be more plans than those that were found ...
    bool has_left_out_ = false;   // ... even while fewer were found than are wanted
};

// Make and run it; a limit that is reached while it is being made is a result, too.
LabelSearchResult label_search(const AnalysedProblem& problem, Valuation& valuation,
                               std::span<const std::optional<ActionName>> names, const LabelSearchOptions& options,
                               Limits& limits, LabelStatistics& statistics);

}  // namespace relax

#endif
