#ifndef RELAX_GROUNDING_FACTS_HPP
#define RELAX_GROUNDING_FACTS_HPP

#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "object_set.hpp"
#include "relation.hpp"
#include "relax/problem/lifted_problem.hpp"

namespace relax::grounding {

// An object for every slot of a schema; what a slot that is not yet bound holds
// means nothing.
using Bindings = std::vector<ObjectId>;

inline ObjectId object_of(Term term, std::span<const ObjectId> bindings) {
    assert(term < static_cast<std::int64_t>(bindings.size()));
    return term >= 0 ? bindings[static_cast<std::size_t>(term)] : static_cast<ObjectId>(~term);
}

// What is known of objects, facts and task instances while grounding goes on.
// Relations: predicates first, then tasks as they are numbered in the lifted
// problem.
struct Knowledge {
    explicit Knowledge(const LiftedProblem& lifted);

    RelationId task_relation(std::uint32_t task) const {
        assert(task < task_count());
        return problem.predicate_count + task;
    }
    bool is_action(std::uint32_t task) const { return task < problem.actions.size(); }
    const std::vector<std::uint32_t>& task_parameters(std::uint32_t task) const {
        return is_action(task) ? problem.actions[task].parameters
                               : problem.tasks[task - problem.actions.size()].parameters;
    }
    std::uint32_t task_count() const {
        return static_cast<std::uint32_t>(problem.actions.size() + problem.tasks.size());
    }

    const LiftedProblem& problem;
    std::vector<ObjectSet> domains;  // as in the lifted problem
    std::vector<Relation> relations;
    std::vector<TupleId> initial_count;  // by predicate: tuples below hold initially
    std::vector<bool> grows;             // by predicate: some action may make an atom of it true
    std::vector<bool> shrinks;           // ... false
};

}  // namespace relax::grounding

#endif
