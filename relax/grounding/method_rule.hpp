#ifndef RELAX_GROUNDING_METHOD_RULE_HPP
#define RELAX_GROUNDING_METHOD_RULE_HPP

#include "demand.hpp"
#include "join.hpp"

namespace relax::grounding {

// The rule whose patterns are the method's distinct subtasks, and whose tests are its constraints.
Rule method_rule(const Knowledge& knowledge, const Demand& demand, std::uint32_t number);

}  // namespace relax::grounding

#endif
