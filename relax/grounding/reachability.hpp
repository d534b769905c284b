#ifndef RELAX_GROUNDING_REACHABILITY_HPP
#define RELAX_GROUNDING_REACHABILITY_HPP

#include <cstdint>
#include <vector>

#include "demand.hpp"
#include "facts.hpp"
#include "relax/base/limits.hpp"
#include "relax/base/rows.hpp"

namespace relax::grounding {

// What hangs on an action besides its precondition and may happen: its effects
// with conditions or variables, and behind them (numbered on from the effects)
// the conditions of its cost.
struct Dependents {
    struct Key {
        std::uint32_t action;  // lifted
        TupleId instance;
        std::uint32_t dependent;
        friend auto operator<=>(const Key&, const Key&) = default;
    };
    std::vector<Key> keys;
    Rows<ObjectId> objects;  // by key: of the dependent's variables
};

// An effect that always happens once.
bool is_simple(const LiftedEffect& effect);

// Set which predicates grow and shrink by the demanded actions.
void classify_predicates(Knowledge& knowledge, const std::vector<bool>& is_demanded);

// Find the instances of actions that are reachable when nothing true ever
// becomes false (and nothing false ever stays so), with the facts that they
// make true. Only demanded arguments are considered.
Dependents reach_actions(Knowledge& knowledge, const Demand& demand, Limits& limits);

// Find the instances of compound tasks that some method can accomplish by
// subtasks with reached instances.
void reach_tasks(Knowledge& knowledge, const Demand& demand, Limits& limits);

}  // namespace relax::grounding

#endif
