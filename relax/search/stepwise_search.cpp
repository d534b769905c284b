#include "relax/search/stepwise_search.hpp"

namespace relax {

bool StepwiseSearch::advance(std::uint64_t most_work) {
    if (!is_done_) {
        stop_ = run_within_limits([&] { return search(most_work); });
        is_done_ = is_done_ || stop_.has_value();
    }
    return is_done_;
}

}  // namespace relax
