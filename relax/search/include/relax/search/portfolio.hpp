#ifndef RELAX_SEARCH_PORTFOLIO_HPP
#define RELAX_SEARCH_PORTFOLIO_HPP

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/limits.hpp"
#include "relax/search/search_options.hpp"
#include "relax/search/search_result.hpp"
#include "relax/search/stepwise_search.hpp"

namespace relax {

// Searches that take turns and share what they have found and proven, `PortfolioOptions::members`. Which one is best
// cannot be told beforehand: the decomposition graph's bound costs next to nothing, and sometimes proves in
// milliseconds what landmark cuts do not in minutes; elsewhere it is the other way round. When one has ended, all have.
//
// Sound: each member's bound holds for every plan that costs less than its upper bound, which is the user's or the cost
// of a plan that some member has found. So no plan is cheaper than the least of the best plan's cost and any member's
// bound, and the greatest of the bounds counts. A member that ends without a plan of its own has proven that no plan is
// cheaper than its upper bound, unless it has given up.
//
// A turn is an amount of work, not of time, so that two runs are the same. Searches with a relaxed model begin when the
// one without has done as much work as it takes to make the model. A member that has proven less than another one has
// with as much work gets a small share only.
//
// If a member is a greedy search, any plan ends all. It gets as much work as all others together, and begins before
// them, so that a plan comes no later than in twice the time that either would take alone.
class Portfolio {
public:
    // As for FindPlans.
    Portfolio(const PricedProblem& priced, const PortfolioOptions& options, Limits& limits,
              SearchStatistics& statistics);
    ~Portfolio();
    Portfolio(const Portfolio&) = delete;
    Portfolio& operator=(const Portfolio&) = delete;

    SearchResult run();

private:
    struct Member {
        std::vector<StepwiseOptions> stages;
        std::uint64_t preparation;                // of its models, for one stage; in units of work
        std::deque<SearchStatistics> statistics;  // of each stage that has begun
        std::unique_ptr<StepwiseSearch> search;   // the latest of them
        std::uint64_t done = 0;                   // work of the earlier ones
        bool has_given_up = false;                // in its last stage

        bool is_greedy() const { return std::holds_alternative<GreedyOptions>(stages.front()); }
        std::uint64_t work() const { return done + (search ? preparation + search->work() : 0); }
    };

    bool take_turn(Member& member, std::uint64_t work);
    bool begin_stage(Member& member);
    bool find_plan();
    bool lags(const Member& member, std::uint64_t work) const;
    void add_up();
    void share_bounds();
    SearchResult gather();

    const PricedProblem& priced_;
    Limits& limits_;
    SearchStatistics& statistics_;
    std::function<bool()> poll_;  // the caller's
    std::optional<Cost> upper_bound_;
    std::vector<Member> members_;
    Member* greedy_ = nullptr;  // the greedy search, if there is one
    Member* ended_ = nullptr;   // the member that has ended all
    std::optional<StopReason> stop_;
};

}  // namespace relax

#endif
