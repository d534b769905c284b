#ifndef RELAX_SEARCH_SEARCH_HPP
#define RELAX_SEARCH_SEARCH_HPP

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/limits.hpp"
#include "relax/search/search_options.hpp"
#include "relax/search/search_result.hpp"

namespace relax {

// Run the search that the options name. `statistics` is kept up to date for whoever
// watches from `limits.poll`.
SearchResult search(const PricedProblem& priced, const SearchOptions& options, Limits& limits,
                    SearchStatistics& statistics);

}  // namespace relax

#endif
