#ifndef RELAX_POLICIES_RECURSION_HPP
#define RELAX_POLICIES_RECURSION_HPP

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "relax/policies/decision_graph.hpp"

namespace relax {

// What a decision is worth, given what its successors are worth: minimised, and monotone in each of them.
//
// Expected: constant + sum of weight * worth. The weight of an outcome is its probability, or 0 where the worth of what
//     comes then is in the constant.
// Averse:   ln sum of e^(weight + worth). The worth is alpha times a cost; the weight of an outcome of probability p is
//     ln p + ln E e^(alpha c).
// Seeking:  -ln sum of e^(weight - worth); the weight is ln p + ln E e^(-alpha c).
// LogExpected: ln(e^constant + sum of e^(weight + worth)). The worth is the logarithm of an expected disutility.
// ExpectedCost: as Expected, with the expected cost of the step as its constant: what tells apart decisions that are
// equal.
//
// All of them are linear in what is carried over (the worth itself, e^worth, e^-worth). What may lead to a node that is
// worth kNever is worth that, too, whatever the other outcomes are: the agent must be done with probability 1, and a
// seeking agent's sum would not show it.
enum class Recursion : std::uint8_t { Expected, Averse, Seeking, LogExpected, ExpectedCost };

namespace recursion {

template <typename Successor, typename WorthOf>
double expected(double constant, std::span<const double> weights, std::span<const Successor> successors,
                WorthOf worth_of) {
    double sum = constant;
    for (std::size_t at = 0; at < successors.size(); ++at) {
        const double worth = worth_of(successors[at]);
        if (worth == kNever) {
            return kNever;
        }
        sum += weights[at] * worth;
    }
    return sum;
}

// `sign`: 1 for averse agents, -1 for those that seek risk. The constant, and what a successor is worth, may be
// -infinity.
template <typename Successor, typename WorthOf>
double exponential(double sign, double constant, std::span<const double> weights, std::span<const Successor> successors,
                   WorthOf worth_of) {
    double largest = constant;
    for (std::size_t at = 0; at < successors.size(); ++at) {
        const double worth = worth_of(successors[at]);
        if (worth == kNever) {
            return kNever;
        }
        largest = std::max(largest, weights[at] + sign * worth);
    }
    if ((successors.size() == 1 && constant == -kNever) || largest == -kNever) {
        return sign * largest;
    }
    double sum = std::exp(constant - largest);
    for (std::size_t at = 0; at < successors.size(); ++at) {
        sum += std::exp(weights[at] + sign * worth_of(successors[at]) - largest);
    }
    return sign * (largest + std::log(sum));
}

}  // namespace recursion

// `successors`: those of the decision, in order, by whatever `worth_of` knows them.
template <typename Successor, typename WorthOf>
double worth_of_decision(const DecisionGraph& graph, Recursion kind, DecisionId decision,
                         std::span<const Successor> successors, WorthOf worth_of) {
    const auto weights = graph.weights(decision);
    switch (kind) {
        case Recursion::Expected:
            return recursion::expected(graph.constant(decision), weights, successors, worth_of);
        case Recursion::Averse:
            return recursion::exponential(1, -kNever, weights, successors, worth_of);
        case Recursion::Seeking:
            return recursion::exponential(-1, -kNever, weights, successors, worth_of);
        case Recursion::LogExpected:
            return recursion::exponential(1, graph.constant(decision), weights, successors, worth_of);
        default:
            return recursion::expected(graph.cost(decision), weights, successors, worth_of);
    }
}

template <typename WorthOf>
double worth_of_decision(const DecisionGraph& graph, Recursion kind, DecisionId decision, WorthOf worth_of) {
    return worth_of_decision(graph, kind, decision, graph.successors(decision), worth_of);
}

}  // namespace relax

#endif
