#include "relax/policies/network_source.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "relax/base/cost.hpp"

namespace relax {

void PlanningSource::decide(DecisionGraph& graph, PolicyNodeId node, std::vector<DraftDecision>& drafts) {
    find_decisions(node);
    const AmountLeft left = nodes_[node].left;
    drafts.resize(decisions_.size());
    for (std::size_t at = 0; at < drafts.size(); ++at) {
        follow(decisions_[at], nullptr);
        drafts[at].clear();
        draft(graph, left, decisions_[at], drafts[at]);
    }
}

PlanningSource::Traced PlanningSource::trace(PolicyNodeId node, std::uint32_t decision) {
    find_decisions(node);
    const PairId pair = nodes_[node].pair;
    PolicyDecision& found = decisions_[decision];
    steps_.assign(1, {nodes_.state(pair), nodes_.network(pair), found.step, std::nullopt});
    follow(found, &steps_);
    branches_.clear();
    list_branches(nodes_[node].left, found, branches_);
    return {steps_, branches_};
}

void PlanningSource::find_decisions(PolicyNodeId node) {
    const auto [pair, left] = nodes_[node];
    heeds_costs_ = left >= 0;
    progression_.decisions(nodes_.state(pair), nodes_.network(pair), decisions_, heeds_costs_);
}

// Let a decision go on as long as it can. Recursion might do so for ever.
void PlanningSource::follow(PolicyDecision& decision, std::vector<TracedStep>* steps) {
    constexpr std::uint32_t kMostSteps = 100;
    for (std::uint32_t count = 0; follows_forced_ && count < kMostSteps; ++count) {
        if (decision.outcomes.size() != 1 || !progression_.costs_and_changes_nothing(decision.outcomes.front())) {
            return;
        }
        const PolicyOutcome& to = decision.outcomes.front();
        progression_.decisions(to.state, to.network, next_, heeds_costs_);
        if (next_.size() != 1) {
            return;
        }
        if (steps != nullptr) {
            steps->push_back({to.state, to.network, next_.front().step, to.action});
        }
        std::swap(decision.outcomes, next_.front().outcomes);
    }
}

NetworkSource::NetworkSource(PolicyProgression& progression, std::vector<double> probabilities,
                             const StepAmounts& amounts, const StepAmounts& costs, const Worths& worths,
                             const PricedProblem& priced, const HeuristicInfo& heuristic, Limits& limits)
    : PlanningSource(progression, std::move(probabilities)),
      amounts_(amounts),
      costs_(costs),
      worths_(worths),
      bounds_(priced, heuristic, progression, nodes_, limits) {}

PolicyNodeId NetworkSource::add_root(DecisionGraph& graph) {
    const StateId state = progression_.initial_state();
    return add(graph, state, progression_.initial_network());
}

PolicyNodeId NetworkSource::add(DecisionGraph& graph, StateId state, NetworkId network) {
    const PairId pair = nodes_.pair_of(state, network);
    const PolicyNodeId node = nodes_.find(pair, 0);
    if (!nodes_.has(node)) {
        if (progression_.is_done(network)) {
            graph.add_done(0);
        } else {
            graph.add_open(worth_of(bounds_.known(pair)), worths_.stop,
                           static_cast<float>(progression_.networks().size(network)));
        }
        nodes_.add(pair, 0);
    }
    return node;
}

void NetworkSource::draft(DecisionGraph& graph, AmountLeft /*left*/, const PolicyDecision& decision,
                          DraftDecision& draft) {
    const bool is_expected = worths_.recursion == Recursion::Expected;
    for (const PolicyOutcome& outcome : decision.outcomes) {
        const double p = probability(outcome);
        if (p > 0) {
            const double amount = amounts_.of(outcome);
            draft.constant += is_expected ? p * amount : 0;
            draft.cost += p * costs_.of(outcome);
            draft.weights.push_back(is_expected ? p : std::log(p) + amount);
            draft.successors.push_back(add(graph, outcome.state, outcome.network));
        }
    }
}

void NetworkSource::list_branches(AmountLeft /*left*/, const PolicyDecision& decision,
                                  std::vector<TracedBranch>& branches) {
    for (const PolicyOutcome& outcome : decision.outcomes) {
        if (const double p = probability(outcome); p > 0) {
            branches.push_back(
                {p, outcome.action, outcome.due_parts, nodes_.find(nodes_.pair_of(outcome.state, outcome.network), 0)});
        }
    }
}

double NetworkSource::bound(PolicyNodeId node, double known) {
    return std::max(known, worth_of(bounds_.closer(nodes_[node].pair)));
}

}  // namespace relax
