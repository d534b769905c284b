#ifndef RELAX_SEARCH_FIND_PLANS_HPP
#define RELAX_SEARCH_FIND_PLANS_HPP

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/segmented_array.hpp"
#include "relax/heuristics/selective_heuristic.hpp"
#include "relax/networks/network_bounds.hpp"
#include "relax/progression/ending.hpp"
#include "relax/progression/progression.hpp"
#include "relax/search/forced_cycle.hpp"
#include "relax/search/open_list.hpp"
#include "relax/search/search_options.hpp"
#include "relax/search/search_result.hpp"
#include "relax/search/search_space.hpp"
#include "relax/search/stepwise_search.hpp"

namespace relax {

// FindPlans (the paper's Algorithm 4): best-first search over states and task networks. Open nodes carry a cheap lower
// bound until they are popped; then the heuristics are asked, one by one, and if f rises they are put back. Of nodes
// with the same state and networks of one form the best is kept, and reopened when a cheaper way to it turns up.
//
// Its goal test is the empty network. (The paper's returns as soon as all tasks are primitive, which would drop them.)
class FindPlans final : public StepwiseSearch {
public:
    // The heuristics must be admissible. `statistics` is kept up to date for whoever
    // watches from `limits.poll`.
    FindPlans(const PricedProblem& priced, const SearchOptions& options, Limits& limits,
              SearchStatistics& statistics);  // throws Stopped

    // Search to the end.
    SearchResult run();

    bool advance(std::uint64_t work) override;
    std::uint64_t work() const override;
    void set_upper_bound(Cost bound) override {
        options_.upper_bound = std::min(bound, options_.upper_bound.value_or(bound));
    }
    Cost lower_bound() const override { return statistics_.lower_bound.value_or(0); }
    std::optional<Cost> best() const override { return statistics_.best; }
    SearchResult result() override;

private:
    std::optional<StopReason> search(std::uint64_t most_work);
    void start();
    Cost proven() const;
    Cost cutoff() const;
    // Whether priorities are lower bounds.
    bool is_exact() const { return options_.algorithm == SearchAlgorithm::AStar; }
    bool is_stale(const OpenList<NodeId>::Entry& entry) const;
    bool evaluate(NodeId id, Cost f);
    std::optional<Cost> ask(SelectiveHeuristic& heuristic, NodeId id);
    bool can_end(const SearchNode& node);
    std::uint64_t work_of_a_node(const SelectiveHeuristic& heuristic) const;
    void expand(NodeId id);
    void note_branching(NodeId id);
    std::optional<NodeId> follow(NodeId id);
    std::optional<NodeId> generate(NodeId parent, const Successor& successor);
    bool is_as_good(const SearchNode& known, Cost g, NetworkId network);
    Cost cheap_bound(const SearchNode& parent, Cost cost, NetworkId network);
    Cost priority(NodeId id) const;
    bool is_beyond(Cost g, Cost h);
    bool cannot_improve(const SearchNode& node);
    void push(NodeId id);
    Cost open_bound() const;

    const PricedProblem& priced_;
    const AnalysedProblem& problem_;
    SearchOptions options_;
    Limits& limits_;
    SearchStatistics& statistics_;
    Progression progression_;
    NetworkBounds bounds_;
    std::optional<Ending> ending_;
    ForcedCycle forced_cycle_;
    std::vector<SelectiveHeuristic> heuristics_;
    SearchSpace nodes_;
    OpenList<NodeId> open_;
    std::optional<NodeId> goal_;  // of the best plan so far
    std::optional<StopReason> stop_;
    bool is_done_ = false;
    bool is_expanding_ = false;    // in the middle of an expansion, where a node is in no list
    bool has_overflowed_ = false;  // there may be plans that cost `kMostCost` or more
    std::vector<Successor> successors_;
    std::vector<Successor> forced_;
    std::uint64_t decided_ = 0;  // nodes expanded that had several successors, or looked so
};

}  // namespace relax

#endif
