#include "relax/policies/policy_chord.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "relax/policies/envelope.hpp"
#include "relax/policies/policy_iteration.hpp"
#include "relax/policies/sure_region.hpp"

namespace relax {

namespace {

constexpr double kLeastShare = 1e-12;  // of an outcome's probability, that it keeps
constexpr std::uint32_t kMostExplorations = 32;
constexpr double kViolation = 1e-11;  // of a worth, or of 1: by how much it may be above that of a decision

class ChordFinder {
public:
    ChordFinder(PlanningSource& source, const DecisionGraph& graph, const ChordPrices& prices, Limits& limits)
        : source_(source), graph_(graph), prices_(prices), limits_(limits), averse_(tilted_), ends_(lines_) {
        for (std::size_t number = graph.size(); number-- > 0;) {
            const DecisionGraph::Node& node = graph[PolicyNodeId(number)];
            if (node.is_expanded && !node.is_done && node.lower != kNever) {
                members_.emplace_back(number);
            }
        }
    }

    std::optional<Chord> find(PolicyNodeId root) {
        copy_nodes(tilted_, prices_.explored / prices_.touching);
        for (const PolicyNodeId node : members_) {
            add_outcomes(node);
        }
        averse_.assign(members_, Outside::Lower);
        PolicyIteration(limits_).improve(averse_, Recursion::Averse);
        if (averse_.worth_of(root) == kNever) {
            return std::nullopt;
        }
        copy_nodes(lines_, prices_.explored);
        for (const PolicyNodeId node : members_) {
            add_lines(node);
        }
        ends_.assign(members_, Outside::Lower);
        for (std::uint32_t place = 0; place < ends_.size(); ++place) {
            ends_.choose(place, averse_.choice(place));  // decisions have the same numbers
        }
        SureRegion(limits_).make_proper(ends_);
        for (std::uint32_t place = 0; place < ends_.size(); ++place) {
            is_hopeless_.push_back(ends_.worth(place) == kNever);
        }
        Chord chord{};
        if (!solve(Recursion::Expected, root, chord.at_low) || !solve(Recursion::ExpectedCost, root, chord.at_high)) {
            return std::nullopt;
        }
        return chord;
    }

    // The open nodes that the policies of both ends meet.
    std::span<const PolicyNodeId> met_open() const { return open_; }

private:
    struct Outcome {
        double probability;
        double at_low;   // its price
        double at_high;  // likewise
    };

    void copy_nodes(DecisionGraph& to, double scale) const {
        for (std::size_t number = 0; number < graph_.size(); ++number) {
            const DecisionGraph::Node& node = graph_[PolicyNodeId(number)];
            if (node.is_done) {
                to.add_done(node.lower * scale);
            } else {
                to.add_open(node.lower * scale, node.stop * scale, node.depth);
            }
        }
    }

    // The decisions of a node for the agent of the touching point.
    void add_outcomes(PolicyNodeId node) {
        limits_.stop_if_reached();
        const double share = (prices_.touching - prices_.low) / (prices_.high - prices_.low);
        drafts_.clear();
        source_.trace_all(node, [&](std::span<const TracedBranch> branches) {
            DraftDecision& draft = drafts_.emplace_back();
            for (const TracedBranch& branch : branches) {
                const double low = prices_.at_low.of(branch);
                const double high = prices_.at_high.of(branch);
                outcomes_.push_back({branch.probability, low, high});
                draft.successors.push_back(branch.successor);
                draft.weights.push_back(std::log(branch.probability) + (low + share * (high - low)) / prices_.touching);
            }
        });
        tilted_.expand(node, drafts_);
        const DecisionGraph::Node& explored = graph_[node];
        tilted_[node].choice =
            explored.choice == kStop ? kStop : DecisionId(tilted_[node].first + (explored.choice - explored.first));
    }

    // The same decisions with the laws that this agent sees, and what their lines are at both ends.
    void add_lines(PolicyNodeId node) {
        limits_.stop_if_reached();
        drafts_.clear();
        for (const DecisionId decision : tilted_.decisions_of(node)) {
            DraftDecision& draft = drafts_.emplace_back();
            const auto successors = tilted_.successors(decision);
            const auto outcomes = std::span(outcomes_).subspan(tilted_.first_outcome(decision), successors.size());
            draft.successors.assign(successors.begin(), successors.end());
            tilt(decision, outcomes, draft.weights);
            double divergence = 0;
            for (std::size_t at = 0; at < outcomes.size(); ++at) {
                const double weight = draft.weights[at];
                divergence += weight * std::log(weight / outcomes[at].probability);
                draft.constant += weight * outcomes[at].at_low;
                draft.cost += weight * outcomes[at].at_high;
            }
            draft.constant -= prices_.low * divergence;
            draft.cost -= prices_.high * divergence;
        }
        lines_.expand(node, drafts_);
    }

    void tilt(DecisionId decision, std::span<const Outcome> outcomes, std::vector<double>& weights) const {
        const auto successors = tilted_.successors(decision);
        double largest = -kNever;
        for (std::size_t at = 0; at < outcomes.size(); ++at) {
            weights.push_back(tilted_.weights(decision)[at] + potential(successors[at]));
            largest = std::max(largest, weights.back());
        }
        if (largest == kNever || outcomes.size() == 1) {  // never taken; or nothing can be seen of it
            std::ranges::transform(outcomes, weights.begin(), &Outcome::probability);
            return;
        }
        double sum = 0;
        for (double& weight : weights) {
            weight = std::exp(weight - largest);
            sum += weight;
        }
        double kept = 0;
        for (std::size_t at = 0; at < weights.size(); ++at) {
            weights[at] = std::max(weights[at] / sum, kLeastShare * outcomes[at].probability);
            kept += weights[at];
        }
        for (double& weight : weights) {
            weight /= kept;
        }
    }

    // Where it is infinite, that of the agent whose graph it is; kNever where that is, too.
    double potential(PolicyNodeId node) const {
        const double worth = averse_.worth_of(node);
        return worth == kNever ? graph_[node].lower * prices_.explored / prices_.touching : worth;
    }

    bool solve(Recursion end, PolicyNodeId root, double& worth) {
        PolicyIteration(limits_).improve(ends_, end);
        for (std::uint32_t place = 0; place < ends_.size(); ++place) {
            if (is_hopeless_[place]) {
                continue;
            }
            const double most = ends_.worth(place) - kViolation * std::max(1.0, std::abs(ends_.worth(place)));
            const auto decisions = lines_.decisions_of(ends_.node(place));
            if (!std::isfinite(most) || ends_.stop(place) < most || std::ranges::any_of(decisions, [&](auto decision) {
                    return ends_.worth_by(place, end, decision) < most;
                })) {
                return false;
            }
        }
        worth = ends_.worth_of(root);
        note_open(root);
        return true;
    }

    void note_open(PolicyNodeId root) {
        std::vector<bool> is_met(graph_.size());
        std::vector<PolicyNodeId> met{root};
        is_met[root] = true;
        while (!met.empty()) {
            const PolicyNodeId node = met.back();
            met.pop_back();
            const DecisionGraph::Node& explored = graph_[node];
            if (!explored.is_expanded && explored.lower < explored.stop) {
                open_.push_back(node);
            }
            const std::uint32_t place = ends_.place(node);
            for (const PolicyNodeId to : ends_.successors(place < ends_.size() ? ends_.choice(place) : kStop)) {
                if (!is_met[to]) {
                    is_met[to] = true;
                    met.push_back(to);
                }
            }
        }
    }

    PlanningSource& source_;
    const DecisionGraph& graph_;
    const ChordPrices& prices_;
    Limits& limits_;
    std::vector<PolicyNodeId> members_;  // as of an envelope
    std::vector<DraftDecision> drafts_;
    std::vector<Outcome> outcomes_;  // by outcome of the graphs
    DecisionGraph tilted_;           // worths are in units of the touching point
    DecisionGraph lines_;            // constants are the sums of steps at the lower end, costs at the upper one
    Envelope averse_;
    Envelope ends_;
    std::vector<bool> is_hopeless_;  // by place
    std::vector<PolicyNodeId> open_;
};

}  // namespace

std::optional<Chord> chord_below(PlanningSource& source, PolicySearch& search, const ChordPrices& prices,
                                 Limits& limits) {
    for (std::uint32_t round = 1;; ++round) {
        ChordFinder finder(source, search.graph(), prices, limits);
        const std::optional<Chord> found = finder.find(search.root());
        const bool is_enough =
            found && found->at_low >= prices.enough.at_low && found->at_high >= prices.enough.at_high;
        if (is_enough || finder.met_open().empty() || round == kMostExplorations) {
            return found;
        }
        search.explore_from(finder.met_open());
    }
}

}  // namespace relax
