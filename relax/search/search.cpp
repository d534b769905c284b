#include "relax/search/search.hpp"

#include <limits>
#include <utility>

#include "relax/search/find_plans.hpp"
#include "relax/search/greedy_search.hpp"
#include "relax/search/plan_based.hpp"
#include "relax/search/portfolio.hpp"

namespace relax {

namespace {

SearchResult finish(StepwiseSearch&& search) {
    search.advance(std::numeric_limits<std::uint64_t>::max());
    return search.result();
}

SearchResult search_or_throw(const PricedProblem& priced, const SearchOptions& options, Limits& limits,
                             SearchStatistics& statistics) {
    if (options.algorithm == SearchAlgorithm::Greedy) {
        return finish(GreedySearch(priced, options, limits, statistics));
    }
    if (options.algorithm == SearchAlgorithm::PlanBased) {
        return PlanBased(priced, options, limits, statistics).run();
    }
    if (options.algorithm == SearchAlgorithm::Portfolio) {
        return Portfolio(priced, options, limits, statistics).run();
    }
    return finish(FindPlans(priced, options, limits, statistics));
}

// The end of a search that a limit stopped while it was being prepared.
SearchResult stopped_early(StopReason reason, const SearchStatistics& statistics) {
    SearchResult result;
    result.status = status_of(reason);
    result.stop = reason;
    result.statistics = statistics;
    return result;
}

}  // namespace

SearchResult search(const PricedProblem& priced, const SearchOptions& options, Limits& limits,
                    SearchStatistics& statistics) {
    SearchResult result;
    const auto stop = run_within_limits([&]() -> std::optional<StopReason> {
        result = search_or_throw(priced, options, limits, statistics);
        return std::nullopt;
    });
    return stop ? stopped_early(*stop, statistics) : result;
}

}  // namespace relax
