#include "relax/search.hpp"

#include <utility>

#include "relax/find_plans.hpp"
#include "relax/greedy_search.hpp"
#include "relax/plan_based.hpp"
#include "relax/portfolio.hpp"

namespace relax {

SearchResult search(const GroundProblem& problem, std::vector<Cost> costs, const SearchOptions& options, Limits& limits,
                    SearchStatistics& statistics) {
    if (options.algorithm == SearchAlgorithm::Greedy) {
        return GreedySearch(problem, std::move(costs), options, limits, statistics).run();
    }
    if (options.algorithm == SearchAlgorithm::PlanBased) {
        return PlanBased(problem, std::move(costs), options, limits, statistics).run();
    }
    if (options.algorithm == SearchAlgorithm::Portfolio) {
        return Portfolio(problem, std::move(costs), options, limits, statistics).run();
    }
    return FindPlans(problem, std::move(costs), options, limits, statistics).run();
}

}  // namespace relax
