#ifndef RELAX_POLICIES_REMEMBERING_SOURCE_HPP
#define RELAX_POLICIES_REMEMBERING_SOURCE_HPP

#include <vector>

#include "relax/base/limits.hpp"
#include "relax/policies/network_source.hpp"
#include "relax/valuations/cost_laws.hpp"

namespace relax {

// A source that remembers what is left of an amount: an outcome has a branch for each of its costs that leaves
// something or nothing, and one for all that cost more.
class RememberingSource : public PlanningSource {
protected:
    RememberingSource(PolicyProgression& progression, std::vector<double> probabilities, const CostLaws& laws,
                      Limits& limits);

    // Whether a node remembers nothing any more.
    static bool is_beyond(AmountLeft left) { return left < 0; }
    const Law& law_of(const PolicyOutcome& outcome);  // throws Stopped

    Limits& limits_;
    AmountLeft base_ = 0;  // what nodes have as what is left where that is nothing

private:
    void list_branches(AmountLeft left, const PolicyDecision& decision, std::vector<TracedBranch>& branches) final;

    LawsSoFar laws_;
};

}  // namespace relax

#endif
