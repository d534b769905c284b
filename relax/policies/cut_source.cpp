#include "relax/policies/cut_source.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "relax/base/cost.hpp"

namespace relax {

CutSource::CutSource(PolicyProgression& progression, std::vector<double> probabilities, const CostLaws& laws,
                     const Costs& costs, const std::vector<PricedTerm>& terms, const HeuristicInfo& heuristic,
                     Limits& limits)
    : RememberingSource(progression, std::move(probabilities), laws, limits),
      costs_(costs),
      sign_(terms.front().term.is_only_sought() ? -1 : 1) {
    for (const PricedTerm& term : terms) {
        terms_.push_back(term.term);
        amounts_.push_back(term.amounts);
        units_.push_back(term.unit);
        bounds_.push_back(std::make_unique<PairBounds>(*term.priced, heuristic, progression, nodes_, limits));
    }
}

void CutSource::set_cut(AmountLeft cut) {
    const auto [found, is_new] = bases_.try_emplace(cut, next_base_);
    if (is_new) {
        assert(cut < std::numeric_limits<AmountLeft>::max() - next_base_);
        next_base_ += cut + 1;
    }
    cut_ = cut;
    base_ = found->second;
    root_ = base_ + cut;
}

PolicyNodeId CutSource::add_root(DecisionGraph& graph) {
    const StateId state = progression_.initial_state();
    return add(graph, state, progression_.initial_network(), root_);
}

PolicyNodeId CutSource::add(DecisionGraph& graph, StateId state, NetworkId network, AmountLeft left) {
    const PairId pair = nodes_.pair_of(state, network);
    const PolicyNodeId node = nodes_.find(pair, left);
    if (!nodes_.has(node)) {
        if (progression_.is_done(network)) {
            graph.add_done(is_beyond(left) ? worth(term_of(left), 0) : worth_of(terms_, spent(left)));
        } else {
            const double worth = lower(left, [&](std::size_t term) { return bounds_[term]->known(pair); });
            graph.add_open(worth, stop(left), static_cast<float>(progression_.networks().size(network)));
        }
        nodes_.add(pair, left);
    }
    return node;
}

// `cost_of`: what a pair costs at least by a term, in its units. Giving up costs no more than that it does.
template <typename CostOf>
double CutSource::lower(AmountLeft left, CostOf cost_of) const {
    const auto least = [&](std::size_t term) {
        const Cost bound = cost_of(term);
        const double cost = bound >= kInfinity ? kNever : units_[term] * static_cast<double>(bound);
        return std::min(cost, costs_.failure);
    };
    if (is_beyond(left)) {
        const double cost = least(term_of(left));
        return cost == kNever ? kNever : worth(term_of(left), cost);
    }
    double sum = -kNever;
    for (std::size_t term = 0; term < terms_.size(); ++term) {
        const double cost = least(term);
        if (cost == kNever) {
            return kNever;
        }
        sum = log_sum(sum, terms_[term].log_weight + terms_[term].log_at(spent(left) + cost));
    }
    return sign_ * sum;
}

double CutSource::stop(AmountLeft left) const {
    if (costs_.failure == kNever) {
        return kNever;
    }
    return is_beyond(left) ? worth(term_of(left), costs_.failure) : worth_of(terms_, spent(left) + costs_.failure);
}

double CutSource::bound(PolicyNodeId node, double known) {
    const auto [pair, left] = nodes_[node];
    return std::max(known, lower(left, [&](std::size_t term) { return bounds_[term]->closer(pair); }));
}

void CutSource::draft_term(DecisionGraph& graph, std::size_t term, const PolicyDecision& decision,
                           DraftDecision& draft) {
    for (const PolicyOutcome& outcome : decision.outcomes) {
        if (const double p = probability(outcome); p > 0) {
            const double amount = amounts_[term].of(outcome);
            draft.constant = log_sum(draft.constant, std::log(p) + terms_[term].log_constant(amount));
            draft.weights.push_back(std::log(p) + terms_[term].log_factor(amount));
            draft.successors.push_back(add(graph, outcome.state, outcome.network, beyond(term)));
        }
    }
}

void CutSource::draft(DecisionGraph& graph, AmountLeft left, const PolicyDecision& decision, DraftDecision& draft) {
    draft.constant = -kNever;
    if (is_beyond(left)) {
        draft_term(graph, term_of(left), decision, draft);
        return;
    }
    for (const PolicyOutcome& outcome : decision.outcomes) {
        const double p = probability(outcome);
        if (p == 0) {
            continue;
        }
        const Law& law = law_of(outcome);
        for (std::size_t at = 0; at < law.size() && law.at[at] <= left - base_; ++at) {
            draft.weights.push_back(std::log(p * law.probability[at]));
            draft.successors.push_back(
                add(graph, outcome.state, outcome.network, static_cast<AmountLeft>(left - law.at[at])));
        }
        if (law.at.back() > left - base_) {
            lead_beyond(graph, left, outcome, law, p, draft);
        }
    }
}

// Of an outcome, what costs more than is left.
void CutSource::lead_beyond(DecisionGraph& graph, double left, const PolicyOutcome& outcome, const Law& law, double p,
                            DraftDecision& draft) {
    for (std::size_t term = 0; term < terms_.size(); ++term) {
        double factor = -kNever;
        for (std::size_t at = law.size(); at-- > 0 && law.at[at] > left - base_;) {
            const double weight = std::log(p * law.probability[at]) + terms_[term].log_weight;
            const double cost = spent(left - law.at[at]);
            draft.constant = log_sum(draft.constant, weight + terms_[term].log_constant(cost));
            factor = log_sum(factor, weight + terms_[term].log_factor(cost));
        }
        draft.weights.push_back(factor);
        draft.successors.push_back(add(graph, outcome.state, outcome.network, beyond(term)));
    }
}

}  // namespace relax
