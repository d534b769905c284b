#ifndef RELAX_SEARCH_HPP
#define RELAX_SEARCH_HPP

#include <vector>

#include "relax/ground_problem.hpp"
#include "relax/limits.hpp"
#include "relax/search_options.hpp"
#include "relax/search_result.hpp"

namespace relax {

// Run the search that the options name. `costs`: by ActionId, at least 0. `statistics` is kept up to date for whoever
// watches from `limits.poll`.
SearchResult search(const GroundProblem& problem, std::vector<Cost> costs, const SearchOptions& options, Limits& limits,
                    SearchStatistics& statistics);

}  // namespace relax

#endif
