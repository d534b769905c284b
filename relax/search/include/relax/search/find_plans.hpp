#ifndef RELAX_SEARCH_FIND_PLANS_HPP
#define RELAX_SEARCH_FIND_PLANS_HPP

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/limits.hpp"
#include "relax/networks/network_bounds.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/forced_steps.hpp"
#include "relax/search/heuristic_sequence.hpp"
#include "relax/search/incumbent.hpp"
#include "relax/search/open_list.hpp"
#include "relax/search/priority.hpp"
#include "relax/search/search_options.hpp"
#include "relax/search/search_space.hpp"
#include "relax/search/stepwise_search.hpp"

namespace relax {

// FindPlans, the paper's Algorithm 4: A* over states and task networks. The numbers in find_plans.cpp are the lines of
// its pseudo-code; src/statehtn/reference/find_plans.py has the same. Costs are positive and minimised. Where it
// differs from the paper, and why:
//
// - Lines 2, 13 and 18: a generated node has a cheap lower bound of the cost to come. computeRCAdHeur is asked when the
//   node is popped; if that raises f, the node goes back into the open list (lazy A*).
// - Line 7: a node is a goal when its network is empty. The paper stops when all tasks are primitive, which would drop
//   them from the plan. A goal is kept as soon as it is generated, and returned when no open node has a lower f.
// - Lines 9 and 10: not every unconstrained task is tried (Progression), and nodes with a single successor are passed
//   through (ForcedSteps).
// - There is a closed list: of all nodes with one state and networks of one form the best is known (SearchSpace). It is
//   opened again when a cheaper path to it is found, since f may fall along a path.
//
// With a weight above 1 the open list is ordered by g + weight h.
class FindPlans final : public StepwiseSearch {
public:
    // The heuristics must be admissible. `statistics` is kept up to date for whoever watches from `limits.poll`.
    FindPlans(const PricedProblem& priced, const FindPlansOptions& options, Limits& limits,
              SearchStatistics& statistics);  // throws Stopped

    std::uint64_t work() const override;
    void set_upper_bound(Cost bound) override { incumbent_.cutoff = std::min(incumbent_.cutoff, bound); }
    Cost lower_bound() const override { return priority_.is_f() ? statistics_.lower_bound.value_or(0) : proven(); }
    SearchResult result() override;

private:
    std::optional<StopReason> search(std::uint64_t most_work) override;
    bool is_stale(const OpenList<NodeId>::Entry& entry) const;
    bool keeps_priority(NodeId id, Cost priority);
    void expand(NodeId id);
    std::optional<NodeId> follow(NodeId id);
    std::optional<NodeId> generate(NodeId parent, const Successor& successor);
    void push(NodeId id);
    std::uint64_t work_without_heuristics() const;
    Cost proven() const;

    FindPlansOptions options_;
    Progression progression_;
    NetworkBounds bounds_;
    HeuristicSequence heuristics_;
    SearchSpace nodes_;
    Priority priority_;
    ForcedSteps forced_steps_;
    OpenList<NodeId> open_;
    Incumbent incumbent_;
    std::optional<NodeId> popped_;  // and not yet expanded
    std::uint64_t decisions_ = 0;   // nodes expanded that were not passed through
    std::vector<Successor> successors_;
};

}  // namespace relax

#endif
