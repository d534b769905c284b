#ifndef RELAX_SEARCH_STEPWISE_SEARCH_HPP
#define RELAX_SEARCH_STEPWISE_SEARCH_HPP

#include <cstdint>
#include <optional>

#include "relax/base/ids.hpp"
#include "relax/search/search_result.hpp"

namespace relax {

// A search that can be left and taken up again, so that several can take turns (see Portfolio).
class StepwiseSearch {
public:
    virtual ~StepwiseSearch() = default;

    // Search on until `work` says so much, or to the end; false: there is more to do.
    virtual bool advance(std::uint64_t work) = 0;
    // What it has done so far, in operators of heuristics looked at or their worth; nodes cost the more, the larger
    // their networks are.
    virtual std::uint64_t work() const = 0;
    // Plans are wanted from now on only if they cost less.
    virtual void set_upper_bound(Cost bound) = 0;
    // What every plan that is wanted costs at least, as far as is known from the nodes that have been looked at.
    virtual Cost lower_bound() const = 0;
    virtual std::optional<Cost> best() const = 0;
    // What it has come to, at the end or so far.
    virtual SearchResult result() = 0;
};

}  // namespace relax

#endif
