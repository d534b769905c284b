#ifndef RELAX_PROGRESSION_STEP_AMOUNTS_HPP
#define RELAX_PROGRESSION_STEP_AMOUNTS_HPP

#include <vector>

#include "relax/base/ids.hpp"

namespace relax {

// An amount for each action and each part of its cost.
struct StepAmounts {
    std::vector<double> actions;  // by ActionId
    std::vector<double> parts;    // by CostPartId

    // Of an outcome with its `action`, if any, and its `due_parts`; 0 where nothing is executed.
    template <typename Outcome>
    double of(const Outcome& outcome) const {
        double sum = outcome.action ? actions[*outcome.action] : 0;
        for (const CostPartId part : outcome.due_parts) {
            sum += parts[part];
        }
        return sum;
    }
};

}  // namespace relax

#endif
