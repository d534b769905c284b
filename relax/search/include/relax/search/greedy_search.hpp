#ifndef RELAX_SEARCH_GREEDY_SEARCH_HPP
#define RELAX_SEARCH_GREEDY_SEARCH_HPP

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/heuristics/heuristic.hpp"
#include "relax/networks/network_bounds.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/forced_cycle.hpp"
#include "relax/search/incumbent.hpp"
#include "relax/search/open_list.hpp"
#include "relax/search/search_options.hpp"
#include "relax/search/search_result.hpp"
#include "relax/search/search_space.hpp"
#include "relax/search/stepwise_search.hpp"
#include "relax/search/type_based_list.hpp"

namespace relax {

// Lazy greedy best-first search with preferred successors (Richter and Westphal, "The LAMA planner", 2010), for a plan
// soon and not for its cost. A node is evaluated when it is popped, and its successors wait with its estimate. Methods
// of the heuristic's relaxed plan wait in a list of their own, too, which has its turn more often as long as that makes
// progress. Every other node may be taken from the type-based list, which leads out of plateaus.
//
// A node with a single successor is nothing to decide: the search goes through it without asking the heuristic. Once it
// has a plan, it goes on for as long as that took, for a cheaper one.
class GreedySearch final : public StepwiseSearch {
public:
    GreedySearch(const PricedProblem& priced, const GreedyOptions& options, Limits& limits,
                 SearchStatistics& statistics);

    std::uint64_t work() const override;
    void set_upper_bound(Cost bound) override { incumbent_.cutoff = std::min(incumbent_.cutoff, bound); }
    // All that is proven is what the root's bound says.
    Cost lower_bound() const override { return proven_; }
    SearchResult result() override;

private:
    std::optional<StopReason> search(std::uint64_t most_work) override;
    NodeId pop();
    std::optional<NodeId> follow(NodeId node);
    std::optional<Cost> evaluate(NodeId node);
    std::optional<NodeId> generate(NodeId parent, const Successor& successor);
    void push_successors(NodeId parent, Cost h);

    GreedyOptions options_;
    Progression progression_;
    NetworkBounds bounds_;
    std::unique_ptr<Heuristic> heuristic_;
    SearchSpace nodes_;
    OpenList<NodeId> open_;
    OpenList<NodeId> preferred_;
    TypeBasedList types_;
    std::int64_t turns_ = 0;            // of the open list
    std::int64_t preferred_turns_ = 0;  // of the list of preferred successors, less what it has earned
    bool explores_ = false;             // the next node comes from the type-based list
    std::optional<Cost> least_h_;
    Cost proven_ = 0;
    Incumbent incumbent_;
    std::uint64_t most_evaluations_;
    std::uint64_t most_work_ = std::numeric_limits<std::uint64_t>::max();
    ForcedCycle forced_cycle_;
    std::vector<Successor> successors_;
};

}  // namespace relax

#endif
