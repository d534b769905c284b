#ifndef RELAX_PORTFOLIO_HPP
#define RELAX_PORTFOLIO_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "relax/find_plans.hpp"
#include "relax/ground_problem.hpp"
#include "relax/heuristic.hpp"
#include "relax/ids.hpp"
#include "relax/limits.hpp"
#include "relax/prices.hpp"
#include "relax/search_options.hpp"
#include "relax/search_result.hpp"

namespace relax {

// A* with cheap and with good heuristics: three searches that take turns and share what they have proven. Which one
// pays is not to be told beforehand: the decomposition graph's bound costs next to nothing, and now and then proves in
// milliseconds what landmark cuts do not in minutes; elsewhere it is the other way round.
//
// A turn is an amount of work, not of time, so that two runs are the same. Searches with a relaxed model begin when the
// one without has done as much as it takes to make the model. Who has proven less than another one has
// with as much work gets a small share only. The first one to end, ends all.
class Portfolio {
public:
    // As for FindPlans.
    Portfolio(const GroundProblem& problem, Prices prices, const SearchOptions& options, Limits& limits,
              SearchStatistics& statistics);

    SearchResult run();  // throws Stopped where nothing was begun

private:
    struct Member {
        HeuristicKind heuristic;
        std::vector<HeuristicKind> more_heuristics;
        SearchStatistics statistics;
        std::unique_ptr<FindPlans> search;  // made for its first turn
    };

    bool take_turn(Member& member, std::uint64_t work);
    bool lags(const Member& member, std::uint64_t work) const;
    void add_up();
    void share_bounds();
    SearchResult gather(Member& ended);

    const GroundProblem& problem_;
    Prices prices_;
    SearchOptions options_;
    Limits& limits_;
    SearchStatistics& statistics_;
    std::vector<Member> members_;
    std::optional<StopReason> stop_;  // why a search could not be made
};

}  // namespace relax

#endif
