#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "id_caster.hpp"
#include "relax/problem/lifted_problem.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using relax::Formula;
using relax::LiftedVariable;

namespace {

using Numbers = std::vector<std::uint32_t>;
using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
using Terms = std::vector<relax::Term>;

using Branch = std::optional<std::pair<std::uint32_t, std::uint32_t>>;  // the block, and which of its branches

std::optional<relax::LiftedBranch> branch_of(const Branch& branch) {
    return branch ? std::optional(relax::LiftedBranch{branch->first, branch->second}) : std::nullopt;
}

std::vector<LiftedVariable> variables_of(const Pairs& pairs) {
    std::vector<LiftedVariable> variables;
    for (const auto& [slot, domain] : pairs) {
        variables.push_back({slot, domain});
    }
    return variables;
}

void add_method(relax::LiftedProblem& problem, Numbers parameters, std::uint32_t slot_count, std::uint32_t task,
                Terms arguments, Formula constraints, const std::vector<std::pair<std::uint32_t, Terms>>& subtasks,
                Pairs ordering) {
    relax::LiftedMethod method{
        std::move(parameters), slot_count, task, std::move(arguments), std::move(constraints), {}, std::move(ordering)};
    for (const auto& [subtask, terms] : subtasks) {
        method.subtasks.push_back({subtask, terms});
    }
    problem.methods.push_back(std::move(method));
}

}  // namespace

void bind_lifted_problem(nb::module_& module) {
    nb::enum_<relax::FormulaKind>(module, "FormulaKind")
        .value("And", relax::FormulaKind::And)
        .value("Or", relax::FormulaKind::Or)
        .value("Not", relax::FormulaKind::Not)
        .value("Atom", relax::FormulaKind::Atom)
        .value("Equals", relax::FormulaKind::Equals)
        .value("InDomain", relax::FormulaKind::InDomain)
        .value("Exists", relax::FormulaKind::Exists)
        .value("Forall", relax::FormulaKind::Forall);

    nb::class_<Formula>(module, "Formula")
        .def(
            "__init__",
            [](Formula* self, relax::FormulaKind kind, std::vector<Formula> operands, std::uint32_t symbol, Terms terms,
               const Pairs& variables) {
                new (self) Formula{kind, std::move(operands), symbol, std::move(terms), variables_of(variables)};
            },
            "kind"_a, "operands"_a = std::vector<Formula>{}, "symbol"_a = 0, "terms"_a = Terms{},
            "variables"_a = Pairs{});

    nb::class_<relax::LiftedEffect>(module, "LiftedEffect")
        .def(
            "__init__",
            [](relax::LiftedEffect* self, const Pairs& variables, Formula condition, std::uint32_t predicate,
               Terms arguments, bool positive, Branch branch) {
                new (self) relax::LiftedEffect{
                    variables_of(variables), std::move(condition), predicate, std::move(arguments), positive,
                    branch_of(branch)};
            },
            "variables"_a, "condition"_a, "predicate"_a, "arguments"_a, "positive"_a, "branch"_a = nb::none());

    nb::class_<relax::LiftedCostCondition>(module, "LiftedCostCondition")
        .def(
            "__init__",
            [](relax::LiftedCostCondition* self, std::uint32_t block, const Pairs& variables, Formula condition,
               Branch branch) {
                new (self)
                    relax::LiftedCostCondition{block, variables_of(variables), std::move(condition), branch_of(branch)};
            },
            "block"_a, "variables"_a, "condition"_a, "branch"_a = nb::none());

    nb::class_<relax::LiftedProblem>(module, "LiftedProblem")
        .def(nb::init<>())
        .def_rw("object_count", &relax::LiftedProblem::object_count)
        .def_rw("predicate_count", &relax::LiftedProblem::predicate_count)
        .def_rw("domains", &relax::LiftedProblem::domains)
        .def_rw("initial_task", &relax::LiftedProblem::initial_task)
        .def_rw("initial_state", &relax::LiftedProblem::initial_state)
        .def(
            "add_action",
            [](relax::LiftedProblem& self, Numbers parameters, std::uint32_t slot_count, Formula precondition,
               std::vector<relax::LiftedEffect> effects, std::vector<relax::LiftedCostCondition> cost_conditions,
               bool is_precondition, const Pairs& outcome_blocks) {
                relax::LiftedAction action{
                    std::move(parameters),      slot_count, std::move(precondition), std::move(effects),
                    std::move(cost_conditions), {},         is_precondition};
                for (const auto& [variables, branches] : outcome_blocks) {
                    action.outcome_blocks.push_back({variables, branches});
                }
                self.actions.push_back(std::move(action));
            },
            "parameters"_a, "slot_count"_a, "precondition"_a, "effects"_a, "cost_conditions"_a, "is_precondition"_a,
            "outcome_blocks"_a = Pairs{})
        .def(
            "add_task",
            [](relax::LiftedProblem& self, Numbers parameters) { self.tasks.push_back({std::move(parameters)}); },
            "parameters"_a)
        .def("add_method", &add_method, "parameters"_a, "slot_count"_a, "task"_a, "arguments"_a, "constraints"_a,
             "subtasks"_a, "ordering"_a);
}
