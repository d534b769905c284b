#include "relax/policies/spending_source.hpp"

#include <algorithm>
#include <utility>

#include "relax/base/cost.hpp"

namespace relax {

SpendingSource::SpendingSource(PolicyProgression& progression, std::vector<double> probabilities, const CostLaws& laws,
                               const Worths& worths, const PricedProblem& least, const PricedProblem& means,
                               double units_per_step, const HeuristicInfo& heuristic, Limits& limits)
    : RememberingSource(progression, std::move(probabilities), laws, limits),
      worths_(worths),
      mean_step_(1 / units_per_step),
      least_(least, heuristic, progression, nodes_, limits),
      means_(means, heuristic, progression, nodes_, limits) {}

PolicyNodeId SpendingSource::add_root(DecisionGraph& graph) {
    const StateId state = progression_.initial_state();
    return add(graph, state, progression_.initial_network(), first_);
}

PolicyNodeId SpendingSource::add(DecisionGraph& graph, StateId state, NetworkId network, AmountLeft left) {
    const PairId pair = nodes_.pair_of(state, network);
    const PolicyNodeId node = nodes_.find(pair, left);
    if (!nodes_.has(node)) {
        if (left == kSpent && (worths_.giving_up == GivingUp::AsBadAsLate || progression_.is_done(network))) {
            graph.add_done(0);
        } else if (progression_.is_done(network)) {
            graph.add_done(worths_.disutility.of(left));
        } else {
            graph.add_open(lower(left, least_.known(pair), means_.known(pair)), stop(left),
                           static_cast<float>(progression_.networks().size(network)));
        }
        nodes_.add(pair, left);
    }
    return node;
}

// The disutility does not fall as less is left.
double SpendingSource::lower(AmountLeft left, Cost least, Cost mean) const {
    if (least >= kInfinity || mean >= kInfinity) {
        return kNever;
    }
    if (left == kSpent) {
        return scale() * mean_step_ * static_cast<double>(mean);
    }
    return worths_.disutility.of(static_cast<double>(left) - static_cast<double>(least));
}

double SpendingSource::stop(AmountLeft left) const {
    switch (worths_.giving_up) {
        case GivingUp::AtACost:
            return left == kSpent ? scale() * worths_.failure
                                  : worths_.disutility.of(static_cast<double>(left) - worths_.failure);
        case GivingUp::AsBadAsLate:
            return worths_.disutility.beyond;
        default:
            return kNever;
    }
}

double SpendingSource::bound(PolicyNodeId node, double known) {
    const auto [pair, left] = nodes_[node];
    const Cost least = left == kSpent ? least_.known(pair) : least_.closer(pair);
    const Cost mean = left == kSpent ? means_.closer(pair) : means_.known(pair);
    return std::max(known, lower(left, least, mean));
}

void SpendingSource::draft_spent(DecisionGraph& graph, const PolicyDecision& decision, DraftDecision& draft) {
    for (const PolicyOutcome& outcome : decision.outcomes) {
        if (const double p = probability(outcome); p > 0) {
            draft.constant += p * scale() * law_of(outcome).mean();
            draft.weights.push_back(p);
            draft.successors.push_back(add(graph, outcome.state, outcome.network, kSpent));
        }
    }
    draft.cost = draft.constant;
}

void SpendingSource::draft(DecisionGraph& graph, AmountLeft left, const PolicyDecision& decision,
                           DraftDecision& draft) {
    if (is_beyond(left)) {
        draft_spent(graph, decision, draft);
        return;
    }
    const double spent_weight = worths_.disutility.slope > 0 ? 1 : 0;
    for (const PolicyOutcome& outcome : decision.outcomes) {
        const double p = probability(outcome);
        if (p == 0) {
            continue;
        }
        const Law& law = law_of(outcome);
        double beyond = 0;
        for (std::size_t at = 0; at < law.size(); ++at) {
            const double rest = left - law.at[at];
            if (rest >= 0) {
                draft.weights.push_back(p * law.probability[at]);
                draft.successors.push_back(add(graph, outcome.state, outcome.network, AmountLeft(rest)));
            } else {
                draft.constant += p * law.probability[at] * worths_.disutility.of(rest);
                beyond += p * law.probability[at];
            }
        }
        if (beyond > 0) {
            draft.weights.push_back(spent_weight * beyond);
            draft.successors.push_back(add(graph, outcome.state, outcome.network, kSpent));
        }
    }
}

}  // namespace relax
