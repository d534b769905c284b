#ifndef RELAX_SEARCH_HPP
#define RELAX_SEARCH_HPP

#include "relax/ground_problem.hpp"
#include "relax/limits.hpp"
#include "relax/prices.hpp"
#include "relax/search_options.hpp"
#include "relax/search_result.hpp"

namespace relax {

// Run the search that the options name. `statistics` is kept up to date for whoever
// watches from `limits.poll`.
SearchResult search(const GroundProblem& problem, Prices prices, const SearchOptions& options, Limits& limits,
                    SearchStatistics& statistics);

}  // namespace relax

#endif
