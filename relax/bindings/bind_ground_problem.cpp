#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "bindings.hpp"
#include "id_caster.hpp"
#include "python_limits.hpp"
#include "relax/analysis/analysed_problem.hpp"
#include "relax/analysis/mutexes.hpp"
#include "relax/grounding/grounder.hpp"
#include "relax/networks/totally_ordered_networks.hpp"
#include "relax/problem/ground_problem.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using relax::AnalysedProblem;
using relax::GroundProblem;

namespace {

// Expose a row of a table as a list.
template <auto Table>
auto row(const AnalysedProblem& problem, std::size_t index) {
    const auto& rows = problem.*Table;
    if (index >= rows.size()) {
        throw std::out_of_range("index out of range");
    }
    const auto values = rows[typename std::remove_cvref_t<decltype(rows)>::Row(index)];
    return std::vector(values.begin(), values.end());
}

// Expose what an owner has of a table of shares as where it begins and ends.
template <auto Table>
std::pair<std::uint32_t, std::uint32_t> share(const AnalysedProblem& problem, std::size_t owner) {
    const auto& shares = problem.*Table;
    if (owner >= shares.size()) {
        throw std::out_of_range("index out of range");
    }
    return shares.bounds(owner);
}

using GroundingResult = std::variant<std::unique_ptr<AnalysedProblem>, relax::StopReason,
                                     std::tuple<std::uint32_t, std::vector<relax::ObjectId>, bool>>;

// Ground, and return the ground problem, why there is none, or which action (schema, arguments) has too many cases, or,
// where the last member says so, too many outcomes.
GroundingResult ground(const relax::LiftedProblem& problem, bool merge_equal, bool replace_single_methods,
                       bool ask_mutexes, std::optional<double> seconds, std::optional<std::size_t> memory_bytes,
                       std::optional<std::uint64_t> steps) {
    relax::Limits limits = python_limits(seconds, memory_bytes, steps);
    std::variant<std::unique_ptr<AnalysedProblem>, relax::StopReason, relax::TooManyCasesOf> result;
    {
        const nb::gil_scoped_release no_gil;
        result = relax::ground(problem, {merge_equal, replace_single_methods, ask_mutexes}, limits);
    }
    if (auto* ground = std::get_if<std::unique_ptr<AnalysedProblem>>(&result)) {
        return std::move(*ground);
    }
    if (const auto* reason = std::get_if<relax::StopReason>(&result)) {
        return *reason;
    }
    const auto& many = std::get<relax::TooManyCasesOf>(result);
    return std::tuple(many.action, many.arguments, many.is_about_outcomes);
}

}  // namespace

void bind_ground_problem(nb::module_& module) {
    nb::enum_<relax::StopReason>(module, "StopReason")
        .value("TimeLimit", relax::StopReason::TimeLimit)
        .value("MemoryLimit", relax::StopReason::MemoryLimit)
        .value("Interrupted", relax::StopReason::Interrupted);

    nb::class_<AnalysedProblem>(module, "GroundProblem")
        .def_prop_ro("fact_count", &GroundProblem::fact_count)
        .def_prop_ro("action_count", &GroundProblem::action_count)
        .def_prop_ro("cost_part_count", &GroundProblem::cost_part_count)
        .def_prop_ro("compound_count", &GroundProblem::compound_count)
        .def_prop_ro("method_count", &GroundProblem::method_count)
        .def_prop_ro("is_totally_ordered",
                     [](const AnalysedProblem& problem) { return relax::TotallyOrderedNetworks::fits(problem); })
        .def_ro("fact_predicate", &GroundProblem::fact_predicate)
        .def_ro("action_schema", &GroundProblem::action_schema)
        .def_ro("compound_schema", &GroundProblem::compound_schema)
        .def_ro("initial_state", &GroundProblem::initial_state)
        .def_ro("initial_task", &GroundProblem::initial_task)
        .def_ro("solvable", &GroundProblem::solvable)
        .def_prop_ro("has_outcomes", &GroundProblem::has_outcomes)
        .def("is_chance",
             [](const AnalysedProblem& problem, std::uint32_t task) {
                 if (task >= problem.task_count()) {
                     throw std::out_of_range("index out of range");
                 }
                 return problem.is_chance(relax::TaskId(task));
             })
        .def("method_task",
             [](const AnalysedProblem& problem, std::size_t method) { return problem.method_task.at(method); })
        .def("method_parts", &share<&GroundProblem::method_parts>)
        .def("part_schema",
             [](const AnalysedProblem& problem, std::size_t part) { return problem.part_schema.at(part); })
        .def("part_origin",
             [](const AnalysedProblem& problem, std::size_t part) { return problem.part_origin.at(part); })
        .def("effects", &share<&GroundProblem::effects>)
        .def("fact_arguments", &row<&GroundProblem::fact_arguments>)
        .def("preconditions", &row<&GroundProblem::preconditions>)
        .def("negative_preconditions", &row<&GroundProblem::negative_preconditions>)
        .def("action_arguments", &row<&GroundProblem::action_arguments>)
        .def("action_cost_blocks", &row<&GroundProblem::action_cost_blocks>)
        .def("action_branches", &row<&GroundProblem::action_branches>)
        .def("cost_parts", &share<&GroundProblem::cost_parts>)
        .def("cost_part_blocks", &row<&GroundProblem::cost_part_blocks>)
        .def("cost_alternatives", &share<&GroundProblem::cost_alternatives>)
        .def("cost_conditions", &row<&GroundProblem::cost_conditions>)
        .def("cost_negative_conditions", &row<&GroundProblem::cost_negative_conditions>)
        .def("effect_conditions", &row<&GroundProblem::effect_conditions>)
        .def("effect_negative_conditions", &row<&GroundProblem::effect_negative_conditions>)
        .def("effect_adds", &row<&GroundProblem::effect_adds>)
        .def("effect_deletes", &row<&GroundProblem::effect_deletes>)
        .def("compound_arguments", &row<&GroundProblem::compound_arguments>)
        .def("part_arguments", &row<&GroundProblem::part_arguments>)
        .def("method_subtasks", &row<&GroundProblem::method_subtasks>)
        .def("method_positions", &row<&GroundProblem::method_positions>)
        .def("method_ordering", &row<&GroundProblem::method_ordering>);

    nb::class_<relax::Mutexes>(module, "Mutexes")
        .def(
            "__init__",
            [](relax::Mutexes* self, const AnalysedProblem& problem) {
                relax::Limits limits;  // none
                new (self) relax::Mutexes(problem, limits);
            },
            "problem"_a)
        .def("are_mutex", &relax::Mutexes::are_mutex, "one"_a, "other"_a)
        .def("is_possible", &relax::Mutexes::is_possible, "action"_a);

    module.def("ground", &ground, "problem"_a, "merge_equal"_a, "replace_single_methods"_a, "ask_mutexes"_a,
               "seconds"_a = nb::none(), "memory_bytes"_a = nb::none(), "steps"_a = nb::none());
}
