#include "relax/search/search.hpp"

#include <limits>
#include <variant>

#include "relax/search/find_plans.hpp"
#include "relax/search/greedy_search.hpp"
#include "relax/search/plan_based.hpp"
#include "relax/search/portfolio.hpp"
#include "relax/valuations/price_sums.hpp"

namespace relax {

namespace {

SearchResult finish(StepwiseSearch&& search) {
    search.advance(std::numeric_limits<std::uint64_t>::max());
    return search.result();
}

SearchResult run(const PricedProblem& priced, const FindPlansOptions& options, Limits& limits,
                 SearchStatistics& statistics) {
    return finish(FindPlans(priced, options, limits, statistics));
}

SearchResult run(const PricedProblem& priced, const GreedyOptions& options, Limits& limits,
                 SearchStatistics& statistics) {
    return finish(GreedySearch(priced, options, limits, statistics));
}

SearchResult run(const PricedProblem& priced, const PlanBasedOptions& options, Limits& limits,
                 SearchStatistics& statistics) {
    PriceSums sums(priced);
    return PlanBased(priced.problem, sums, options, limits, statistics).run();
}

SearchResult run(const PricedProblem& priced, const PortfolioOptions& options, Limits& limits,
                 SearchStatistics& statistics) {
    return Portfolio(priced, options, limits, statistics).run();
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
        result = std::visit([&](const auto& asked) { return run(priced, asked, limits, statistics); }, options);
        return std::nullopt;
    });
    return stop ? stopped_early(*stop, statistics) : result;
}

}  // namespace relax
