#include "relax/policies/remembering_source.hpp"

#include <utility>

namespace relax {

RememberingSource::RememberingSource(PolicyProgression& progression, std::vector<double> probabilities,
                                     const CostLaws& laws, Limits& limits)
    : PlanningSource(progression, std::move(probabilities)), limits_(limits), laws_(laws, LawDetail{}) {}

const Law& RememberingSource::law_of(const PolicyOutcome& outcome) {
    return laws_[outcome.action ? laws_.extend(LawTable::kFree, *outcome.action, outcome.due_parts, limits_)
                                : LawTable::kFree];
}

void RememberingSource::list_branches(AmountLeft left, const PolicyDecision& decision,
                                      std::vector<TracedBranch>& branches) {
    for (const PolicyOutcome& outcome : decision.outcomes) {
        const double p = probability(outcome);
        if (p == 0) {
            continue;
        }
        const PairId pair = nodes_.pair_of(outcome.state, outcome.network);
        const auto put = [&](double probability, AmountLeft rest) {
            branches.push_back({probability, outcome.action, outcome.due_parts, nodes_.find(pair, rest)});
        };
        if (is_beyond(left)) {
            put(p, left);
            continue;
        }
        const Law& law = law_of(outcome);
        double exceeding = 0;
        for (std::size_t at = 0; at < law.size(); ++at) {
            if (law.at[at] <= left - base_) {
                put(p * law.probability[at], static_cast<AmountLeft>(left - law.at[at]));
            } else {
                exceeding += p * law.probability[at];
            }
        }
        if (exceeding > 0) {
            put(exceeding, kSpent);
        }
    }
}

}  // namespace relax
