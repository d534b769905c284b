#ifndef RELAX_PROBLEM_LIFTED_PROBLEM_HPP
#define RELAX_PROBLEM_LIFTED_PROBLEM_HPP

// The lifted problem as the grounder takes it: names are numbers, types are lists of objects ("domains"),
// and three things are compiled into tasks beforehand: the initial network is a method of one initial task, method
// preconditions are actions without effects before the method's subtasks, and the goal is such an action at the very
// end.

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "relax/base/ids.hpp"

namespace relax {

// Not negative: a variable slot of the schema; negative: the bitwise complement of an ObjectId.
using Term = std::int32_t;

struct LiftedVariable {
    std::uint32_t slot;
    std::uint32_t domain;  // index into LiftedProblem::domains
};

enum class FormulaKind : std::uint8_t { And, Or, Not, Atom, Equals, InDomain, Exists, Forall };

struct Formula {
    FormulaKind kind = FormulaKind::And;
    std::vector<Formula> operands;          // And, Or: any number; Not, Exists, Forall: one
    std::uint32_t symbol = 0;               // Atom: predicate; InDomain: domain
    std::vector<Term> terms;                // Atom: arguments; Equals: two; InDomain: one
    std::vector<LiftedVariable> variables;  // Exists, Forall
};

// One of the branches of a block of outcomes of an action, of which nature chooses one.
struct LiftedBranch {
    std::uint32_t block = 0;  // index into LiftedAction::outcome_blocks
    std::uint32_t branch = 0;
};

struct LiftedEffect {
    std::vector<LiftedVariable> variables;  // of a universal effect; first those of its block of outcomes
    Formula condition;
    std::uint32_t predicate = 0;
    std::vector<Term> arguments;
    bool positive = true;
    std::optional<LiftedBranch> branch = std::nullopt;  // none: it happens whatever nature chooses
};

// A condition on which a part of the action's cost depends.
struct LiftedCostCondition {
    std::uint32_t block = 0;  // which part; the grounder only passes it on
    std::vector<LiftedVariable> variables;
    Formula condition;
    std::optional<LiftedBranch> branch = std::nullopt;  // as of effects
};

// A block of outcomes. It has an instance for each of the objects that its variables may be, and nature chooses one
// branch of each, whatever it chooses of the others.
struct LiftedOutcomeBlock {
    std::uint32_t variable_count = 0;
    std::uint32_t branch_count = 0;
};

struct LiftedAction {
    std::vector<std::uint32_t> parameters;  // domains of slots 0, 1, ..
    std::uint32_t slot_count = 0;  // parameters and quantified variables; every quantifier has slots of its own
    Formula precondition;
    std::vector<LiftedEffect> effects;
    std::vector<LiftedCostCondition> cost_conditions;
    std::vector<LiftedOutcomeBlock> outcome_blocks;
    bool is_precondition = false;  // a method precondition or the goal: left out where it is trivially true
};

struct LiftedTask {
    std::vector<std::uint32_t> parameters;  // domains
};

struct LiftedSubtask {
    std::uint32_t task = 0;  // actions first, then compound tasks
    std::vector<Term> arguments;
};

struct LiftedMethod {
    std::vector<std::uint32_t> parameters;
    std::uint32_t slot_count = 0;
    std::uint32_t task = 0;
    std::vector<Term> task_arguments;
    Formula constraints;  // of predicates that no action changes
    std::vector<LiftedSubtask> subtasks;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ordering;
};

struct LiftedProblem {
    std::uint32_t object_count = 0;
    std::uint32_t predicate_count = 0;
    std::vector<std::vector<ObjectId>> domains;
    std::vector<LiftedAction> actions;
    std::vector<LiftedTask> tasks;  // compound
    std::vector<LiftedMethod> methods;
    std::vector<std::vector<std::uint32_t>> initial_state;  // predicate, then objects
    std::uint32_t initial_task = 0;                         // without parameters
};

}  // namespace relax

#endif
