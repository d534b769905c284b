#ifndef RELAX_BINDINGS_CHECKED_PRICES_HPP
#define RELAX_BINDINGS_CHECKED_PRICES_HPP

#include <stdexcept>

#include "relax/analysis/prices.hpp"
#include "relax/problem/ground_problem.hpp"

// Return the prices if they are of this problem; throw otherwise.
inline const relax::Prices& checked(const relax::GroundProblem& problem, const relax::Prices& prices) {
    if (prices.actions.size() != problem.action_count() || prices.parts.size() != problem.cost_part_count()) {
        throw std::invalid_argument("there must be one price for each action and for each cost part");
    }
    return prices;
}

#endif
