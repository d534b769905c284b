#include "relax/valuations/valuation.hpp"

namespace relax {

std::vector<bool> Valuation::free_actions() const {
    std::vector<bool> is_free = prices().front()->free_actions();
    for (const PricedProblem* const priced : prices().subspan(1)) {
        const std::vector<bool> costs_nothing = priced->free_actions();
        for (std::size_t action = 0; action < is_free.size(); ++action) {
            is_free[action] = is_free[action] && costs_nothing[action];
        }
    }
    return is_free;
}

}  // namespace relax
