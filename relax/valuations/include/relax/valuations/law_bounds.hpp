#ifndef RELAX_VALUATIONS_LAW_BOUNDS_HPP
#define RELAX_VALUATIONS_LAW_BOUNDS_HPP

#include "relax/valuations/law_table.hpp"

namespace relax {

// The law that for each cost has the higher one of two laws' probabilities of at most so much: both are stochastically
// at least that. Differences of less than `kProbabilityTolerance` are ignored.
LawId highest_of(LawTable& table, LawId one, LawId other);

// The law with so much of its probability moved from the largest costs to the least one.
LawId lifted(LawTable& table, LawId law, double probability);

}  // namespace relax

#endif
