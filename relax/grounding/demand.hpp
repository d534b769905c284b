#ifndef RELAX_GROUNDING_DEMAND_HPP
#define RELAX_GROUNDING_DEMAND_HPP

#include <vector>

#include "facts.hpp"
#include "relax/base/limits.hpp"

namespace relax::grounding {

// Sets of objects by task, then position.
using ArgumentSets = std::vector<std::vector<ObjectSet>>;

// What types, static facts and equalities in action preconditions leave of each
// task's arguments.
ArgumentSets possible_arguments(const Knowledge& knowledge, Limits& limits);

// The same, but of actions only the arguments of reached instances.
ArgumentSets reached_arguments(const Knowledge& knowledge, Limits& limits);

// Pairs of objects that are asked for at two positions of a task; open: all of them.
struct PairSet {
    Relation pairs{2};
    bool is_open = false;
};

// A relation with the pairs of objects that a task may have at two of its positions.
struct PairRelation {
    RelationId relation;
    std::uint32_t first;
    std::uint32_t second;
};

// The objects that the initial task may pass on to each task, by position and by pairs of positions: where goals are
// tasks, most objects are asked for somewhere, but few pairs of them.
struct Demand {
    // Whether pairs are kept for the task at all.
    bool has_pairs(std::uint32_t task) const { return !pairs[task].empty(); }
    PairSet& pairs_of(std::uint32_t task, std::size_t first, std::size_t second) {
        return pairs[task][first * arguments[task].size() + second];
    }
    const PairSet& pairs_of(std::uint32_t task, std::size_t first, std::size_t second) const {
        return pairs[task][first * arguments[task].size() + second];
    }

    ArgumentSets arguments;
    std::vector<bool> is_demanded;                     // by task
    std::vector<std::vector<ObjectSet>> method_slots;  // by method, then parameter
    std::vector<bool> is_method_demanded;
    std::vector<std::vector<PairSet>> pairs;                // by task, then pair of positions
    std::vector<std::vector<PairRelation>> pair_relations;  // by task: where pairs are asked for that tell something
};

Demand find_demand(const Knowledge& knowledge, const ArgumentSets& possible, Limits& limits);

// Make relations of the demanded pairs, for joins to use.
void add_pair_relations(Knowledge& knowledge, Demand& demand);

}  // namespace relax::grounding

#endif
