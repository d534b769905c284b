#ifndef RELAX_SEARCH_STEPWISE_SEARCH_HPP
#define RELAX_SEARCH_STEPWISE_SEARCH_HPP

#include <cstdint>
#include <optional>

#include "relax/analysis/priced_problem.hpp"
#include "relax/base/cost.hpp"
#include "relax/base/limits.hpp"
#include "relax/search/search_result.hpp"

namespace relax {

// A search that can be left and taken up again, so that several can take turns (see Portfolio).
class StepwiseSearch {
public:
    virtual ~StepwiseSearch() = default;

    // Search on until `work` says so much, or to the end; false: there is more to do.
    bool advance(std::uint64_t most_work);
    // What it has done so far, in operators of heuristics looked at or their worth; nodes cost the more, the larger
    // their networks are.
    virtual std::uint64_t work() const = 0;
    // Plans are wanted from now on only if they cost less.
    virtual void set_upper_bound(Cost bound) = 0;
    // What every plan that is wanted costs at least, as far as is known from the nodes that have been looked at.
    virtual Cost lower_bound() const = 0;
    std::optional<Cost> best() const { return statistics_.best; }
    // What it has come to, at the end or so far.
    virtual SearchResult result() = 0;

protected:
    static constexpr std::uint64_t kWorkOfANode = 200;  // in operators that a heuristic looks at; by time, roughly

    StepwiseSearch(const PricedProblem& priced, Limits& limits, SearchStatistics& statistics)
        : priced_(priced),
          problem_(priced.problem),
          limits_(limits),
          statistics_(statistics),
          is_done_(!priced.problem.solvable) {}

    // Set `is_done_` at the end. Says why it was stopped before that, or throws Stopped.
    virtual std::optional<StopReason> search(std::uint64_t most_work) = 0;

    const PricedProblem& priced_;
    const AnalysedProblem& problem_;
    Limits& limits_;
    SearchStatistics& statistics_;
    bool is_done_;
    std::optional<StopReason> stop_;
};

}  // namespace relax

#endif
