#ifndef RELAX_SRC_GROUNDER_FACTS_HPP
#define RELAX_SRC_GROUNDER_FACTS_HPP

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "grounder_object_set.hpp"
#include "grounder_relation.hpp"
#include "relax/lifted_problem.hpp"

namespace relax::grounding {

// An object for every slot of a schema; what a slot that is not yet bound holds
// means nothing.
using Bindings = std::vector<ObjectId>;

inline ObjectId object_of(Term term, std::span<const ObjectId> bindings) {
    return term >= 0 ? bindings[static_cast<std::size_t>(term)] : static_cast<ObjectId>(~term);
}

// What is known of objects, facts and task instances while grounding goes on.
// Relations: predicates first, then tasks as they are numbered in the lifted
// problem.
struct Knowledge {
    explicit Knowledge(const LiftedProblem& lifted);

    RelationId task_relation(std::uint32_t task) const { return problem.predicate_count + task; }
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

// The formula with negation in front of atoms, equalities and domains only.
Formula negation_normal_form(const Formula& formula, bool negated = false);

// Append the formula's top-level conjuncts; expects negation normal form.
void split_conjunction(const Formula& formula, std::vector<Formula>& conjuncts);

inline bool is_true(const Formula& formula) { return formula.kind == FormulaKind::And && formula.operands.empty(); }

// Append the slots of the formula's variables that none of its quantifiers
// binds, with repetitions.
void free_slots(const Formula& formula, std::vector<std::uint32_t>& slots);

// Append the growing predicates that stand without negation in it: those that
// its relaxed truth waits for.
void awaited_predicates(const Knowledge& knowledge, const Formula& formula, std::vector<std::uint32_t>& predicates);

// Tell whether the formula (in negation normal form) is true where everything
// reached so far is true, and everything that can become false is false. Every
// free variable must be bound; slots of quantified variables are overwritten.
bool is_relaxed_true(const Knowledge& knowledge, const Formula& formula, Bindings& bindings);

// Call `visit` for every binding of the variables, until it returns true.
// Returns whether it did.
template <typename Visit>
bool any_binding(const Knowledge& knowledge, std::span<const LiftedVariable> variables, Bindings& bindings,
                 Visit visit) {
    if (variables.empty()) {
        return visit();
    }
    for (const ObjectId object : knowledge.domains[variables[0].domain].members()) {
        bindings[variables[0].slot] = object;
        if (any_binding(knowledge, variables.subspan(1), bindings, visit)) {
            return true;
        }
    }
    return false;
}

}  // namespace relax::grounding

#endif
