#include "relax/policies/policy_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "relax/policies/disutility_terms.hpp"

namespace relax {

namespace {

constexpr std::uint32_t kElsewhere = std::numeric_limits<std::uint32_t>::max();
constexpr double kSeekingMargin = 0;       // it never is 1: a policy is proper before it is evaluated
constexpr std::uint32_t kMostSweeps = 64;  // for potentials; beyond that they are a little less than the largest path

// What the weights of a decision lack to 1 where they are probabilities but for those of outcomes whose worth is in the
// constant; nothing, where the difference is rounding.
double missing(std::span<const double> weights) {
    constexpr double kRounding = 1e-12;
    double sum = 0;
    for (const double weight : weights) {
        sum += weight;
    }
    return 1 - sum > kRounding ? 1 - sum : 0;
}

}  // namespace

LinearOutcome PolicyEvaluation::evaluate(Envelope& envelope, Recursion kind) {
    index_.assign(envelope.size(), kElsewhere);
    return evaluate(envelope, kind, 0, envelope.size());
}

LinearOutcome PolicyEvaluation::evaluate(Envelope& envelope, Recursion kind, std::uint32_t first, std::uint32_t end) {
    LinearOutcome worst = LinearOutcome::Solved;
    components_.find(
        first, end - first, [&](std::uint32_t place) { return envelope.next(place); },
        [&](std::span<const std::uint32_t> component) {
            worst = std::max(worst, evaluate_component(envelope, kind, component));
        });
    return worst;
}

LinearOutcome PolicyEvaluation::evaluate_component(Envelope& envelope, Recursion kind,
                                                   std::span<const std::uint32_t> component) {
    limits_.stop_if_reached();
    const std::uint32_t first = component.front();
    const auto row = envelope.next(first);
    bool is_loop = component.size() > 1;
    for (std::size_t at = 0; !is_loop && at < row.size(); ++at) {
        is_loop = row[at] == first;
    }
    if (!is_loop) {
        envelope.set_worth(first, envelope.worth_by(first, kind, envelope.choice(first)));
        return LinearOutcome::Solved;
    }
    for (std::uint32_t index = 0; index < component.size(); ++index) {
        index_[component[index]] = index;
    }
    const bool is_expected = kind == Recursion::Expected || kind == Recursion::ExpectedCost;
    const LinearOutcome outcome =
        is_expected ? solve_expected(envelope, kind, component) : solve_exponential(envelope, kind, component);
    for (std::uint32_t index = 0; index < component.size(); ++index) {
        index_[component[index]] = kElsewhere;
        if (outcome != LinearOutcome::Solved) {
            envelope.set_worth(component[index], kNever);
        }
    }
    return outcome;
}

LinearOutcome PolicyEvaluation::solve_expected(Envelope& envelope, Recursion kind,
                                               std::span<const std::uint32_t> component) {
    const DecisionGraph& graph = envelope.graph();
    linear_.begin(component.size(), true, 0);
    for (const std::uint32_t place : component) {
        const DecisionId choice = envelope.choice(place);
        const auto row = envelope.next(place);
        const auto successors = graph.successors(choice);
        const auto weights = graph.weights(choice);
        double constant = kind == Recursion::ExpectedCost ? graph.cost(choice) : graph.constant(choice);
        double leak = missing(weights);
        for (std::size_t at = 0; at < row.size(); ++at) {
            if (row[at] < envelope.size() && index_[row[at]] != kElsewhere) {
                linear_.add(index_[row[at]], weights[at]);
                continue;
            }
            const double worth = envelope.worth_of(successors[at]);
            if (worth == kNever) {
                return LinearOutcome::Infinite;
            }
            constant += weights[at] * worth;
            leak += weights[at];
        }
        linear_.finish_row(constant, leak);
    }
    const LinearOutcome outcome = linear_.solve(limits_);
    if (outcome == LinearOutcome::Solved) {
        for (std::uint32_t index = 0; index < component.size(); ++index) {
            envelope.set_worth(component[index], linear_.solution()[index]);
        }
    }
    return outcome;
}

LinearOutcome PolicyEvaluation::solve_exponential(Envelope& envelope, Recursion kind,
                                                  std::span<const std::uint32_t> component) {
    const DecisionGraph& graph = envelope.graph();
    const double sign = kind == Recursion::Seeking ? -1 : 1;
    exits_.clear();
    for (const std::uint32_t place : component) {
        const auto row = envelope.next(place);
        const auto successors = graph.successors(envelope.choice(place));
        const auto weights = graph.weights(envelope.choice(place));
        double exit = kind == Recursion::LogExpected ? graph.constant(envelope.choice(place)) : -kNever;
        for (std::size_t at = 0; at < row.size(); ++at) {
            if (row[at] < envelope.size() && index_[row[at]] != kElsewhere) {
                continue;
            }
            const double worth = envelope.worth_of(successors[at]);
            if (worth == kNever) {
                return LinearOutcome::Infinite;
            }
            exit = log_sum(exit, weights[at] + sign * worth);
        }
        exits_.push_back(exit);
    }
    find_potentials(envelope, component);
    linear_.begin(component.size(), false, sign > 0 ? kRadiusMargin : kSeekingMargin);
    for (std::uint32_t index = 0; index < component.size(); ++index) {
        const auto row = envelope.next(component[index]);
        const auto weights = graph.weights(envelope.choice(component[index]));
        for (std::size_t at = 0; at < row.size(); ++at) {
            if (row[at] < envelope.size() && index_[row[at]] != kElsewhere) {
                const std::uint32_t to = index_[row[at]];
                linear_.add(to, std::exp(weights[at] + potentials_[to] - potentials_[index]));
            }
        }
        linear_.finish_row(std::exp(exits_[index] - potentials_[index]), 0);
    }
    const LinearOutcome outcome = linear_.solve(limits_);
    if (outcome == LinearOutcome::Solved) {
        for (std::uint32_t index = 0; index < component.size(); ++index) {
            envelope.set_worth(component[index], sign * (potentials_[index] + std::log(linear_.solution()[index])));
        }
    }
    return outcome;
}

// The largest paths out of the component, or, where all that leads out is worth -infinity, within it.
void PolicyEvaluation::find_potentials(const Envelope& envelope, std::span<const std::uint32_t> component) {
    const DecisionGraph& graph = envelope.graph();
    potentials_ = exits_;
    if (std::ranges::all_of(exits_, [](double exit) { return exit == -kNever; })) {
        potentials_.assign(component.size(), 0);
    }
    bool has_changed = true;
    for (std::uint32_t sweep = 0; has_changed; ++sweep) {
        has_changed = false;
        bool is_complete = true;
        for (std::uint32_t index = 0; index < component.size(); ++index) {
            const auto row = envelope.next(component[index]);
            const auto weights = graph.weights(envelope.choice(component[index]));
            for (std::size_t at = 0; at < row.size(); ++at) {
                if (row[at] >= envelope.size() || index_[row[at]] == kElsewhere) {
                    continue;
                }
                const double path = weights[at] + potentials_[index_[row[at]]];
                if (path > potentials_[index]) {
                    potentials_[index] = path;
                    has_changed = true;
                }
            }
            is_complete = is_complete && potentials_[index] > -kNever;
        }
        limits_.stop_if_reached();
        if (is_complete && sweep >= kMostSweeps) {
            return;
        }
    }
}

}  // namespace relax
