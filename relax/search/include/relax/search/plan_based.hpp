#ifndef RELAX_SEARCH_PLAN_BASED_HPP
#define RELAX_SEARCH_PLAN_BASED_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "relax/analysis/analysed_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/networks/network_bounds.hpp"
#include "relax/progression/open_preconditions.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/label_search.hpp"
#include "relax/search/linearisation.hpp"
#include "relax/search/open_list.hpp"
#include "relax/search/search_options.hpp"
#include "relax/search/search_result.hpp"
#include "relax/valuations/valuation.hpp"

namespace relax {

// The paper's Algorithm 3, the plan-based solver: A* over task networks, without a state. The numbers in plan_based.cpp
// are the lines of its pseudo-code; src/statehtn/reference/plan_based.py has the same. A network's f is the sum of its
// primitive tasks' costs (g) and of its compound tasks' decomposition-graph bounds (h); for other objectives, what the
// valuation says of such sums: a network determines which actions it has, so that it has one label. Where it differs
// from the paper, and why:
//
// - Lines 10 and 11: a primitive network is a solution if some order of it can be executed (Linearisation). Where costs
//   depend on the state, f is a lower bound of what that costs. The best solution is kept, and returned when no open
//   network has a lower f.
// - Line 12: decomposing a task excludes no decomposition of another one, so that any plan's decompositions can be made
//   in any order, and it is enough to branch over one compound task, the one with the fewest methods.
//   `PlanBasedOptions::branches_over_all` tries every task, as the paper writes it.
// - Line 20: networks with a precondition that nothing can make true any more are left out (OpenPreconditions); the
//   paper finds out when all their tasks are primitive.
class PlanBased {
public:
    PlanBased(const AnalysedProblem& problem, Valuation& valuation, const PlanBasedOptions& options, Limits& limits,
              SearchStatistics& statistics);

    // The plan's cost is that at the valuation's first prices, `best` of the statistics what it is worth.
    SearchResult run();

private:
    // A network and a path to it. All paths to a network have the same f.
    struct Node {
        NetworkId network;
        NodeId parent;  // itself for the root
        SearchStep step;
    };
    struct Solution {
        NodeId node;
        Worth worth;
        std::vector<SearchStep> order;
    };

    std::optional<StopReason> search();
    std::optional<StopReason> execute(NodeId node);
    std::optional<StopReason> find_best_order(NodeId node, Linearisation::Order order);
    Worth bound(NetworkId network);
    Worth cutoff() const;
    void expand(NodeId node);
    void generate(NodeId parent, NetworkId network, const SearchStep& step);
    void look_at(NetworkId network);
    void trace(SearchResult& result);

    const AnalysedProblem& problem_;
    Valuation& valuation_;
    PlanBasedOptions options_;
    Limits& limits_;
    SearchStatistics& statistics_;
    std::vector<bool> is_choice_;                 // by TaskId: the case of an action is chosen when it is executed
    std::vector<std::vector<Cost>> task_bounds_;  // by price, by TaskId
    Progression progression_;
    std::vector<NetworkBounds> bounds_;  // by price
    Linearisation linearisation_;
    OpenPreconditions open_preconditions_;
    SegmentedArray<Node> nodes_;
    std::vector<bool> is_known_;  // by NetworkId: the closed list
    OpenList<NodeId> open_;
    std::optional<Solution> solution_;   // the best so far
    bool has_overflowed_ = false;        // there may be plans that are worth `most` of the valuation or more
    OrderedTasks tasks_;                 // of the network looked at
    std::vector<Occurrence> compounds_;  // likewise
    std::vector<Cost> least_;            // likewise, by price
};

// Make and run it for an objective whose label is not one price.
LabelSearchResult plan_based_search(const AnalysedProblem& problem, Valuation& valuation,
                                    const PlanBasedOptions& options, Limits& limits, LabelStatistics& statistics);

}  // namespace relax

#endif
