#ifndef RELAX_VALUATIONS_SCENARIO_OPTIONS_HPP
#define RELAX_VALUATIONS_SCENARIO_OPTIONS_HPP

#include <memory>

#include "relax/valuations/law_objective.hpp"

namespace relax {

// Each rule and each bound can be left out. All of them are sound (see scenario_totals.hpp, scenario_laws.hpp).
struct ScenarioOptions {
    bool compare_scenarios = true;  // ways are compared at all
    bool decided_scenarios = true;  // scenarios in which a way cannot but get beyond the last kink do not count
    bool ideal_bound = true;
    bool tangent_bound = true;
};

// A budget that is to be kept with a probability, over all scenarios: plans are wanted that miss it with at most so
// much, the deadline being an objective itself.
struct ScenarioBudget {
    std::shared_ptr<const LawObjective> deadline;
    double most;
};

}  // namespace relax

#endif
