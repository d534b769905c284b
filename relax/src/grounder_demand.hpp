#ifndef RELAX_SRC_GROUNDER_DEMAND_HPP
#define RELAX_SRC_GROUNDER_DEMAND_HPP

#include <vector>

#include "grounder_facts.hpp"

namespace relax::grounding {

// Sets of objects by task, then position.
using ArgumentSets = std::vector<std::vector<ObjectSet>>;

// What types, static facts and equalities in action preconditions leave of each
// task's arguments.
ArgumentSets possible_arguments(const Knowledge& knowledge);

// The same, but of actions only the arguments of reached instances.
ArgumentSets reached_arguments(const Knowledge& knowledge);

// The objects that the initial task may hand down to each task, position by
// position.
struct Demand {
    ArgumentSets arguments;
    std::vector<bool> is_demanded;                     // by task
    std::vector<std::vector<ObjectSet>> method_slots;  // by method, then parameter
    std::vector<bool> is_method_demanded;
};

Demand find_demand(const Knowledge& knowledge, const ArgumentSets& possible);

}  // namespace relax::grounding

#endif
