#ifndef RELAX_PRUNING_HPP
#define RELAX_PRUNING_HPP

#include <cstdint>
#include <vector>

#include "cases.hpp"
#include "reachability.hpp"

namespace relax {

// What is left of the instances, and which of their literals still tell something.
struct Pruned {
    std::vector<bool> case_lives;    // by index into the action cases
    std::vector<bool> method_lives;  // by index into Reachability::methods()
    std::vector<bool> can_hold;      // by Literal: some living case makes it true, or it is true initially
    bool solvable = false;

    // A literal whose negation can never hold tells nothing.
    bool is_certain(Literal literal) const { return !can_hold[literal ^ 1U]; }
};

// Drop, until nothing changes, action cases that cannot be reached by the others, methods that contain a task without a
// finite decomposition, and whatever the initial task does not lead to.
Pruned prune(const Reachability& reachability, const CaseBuilder& facts, const std::vector<ActionCase>& cases);

}  // namespace relax

#endif
