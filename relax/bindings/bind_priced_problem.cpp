#include <nanobind/nanobind.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "relax/analysis/analysed_problem.hpp"
#include "relax/analysis/priced_problem.hpp"

namespace nb = nanobind;
using namespace nb::literals;

void bind_priced_problem(nb::module_& module) {
    nb::class_<relax::PricedProblem>(module, "PricedProblem")
        .def(
            "__init__",
            [](relax::PricedProblem* self, const relax::AnalysedProblem& problem, std::vector<relax::Cost> actions,
               std::vector<relax::Cost> parts) {
                if (actions.size() != problem.action_count() || parts.size() != problem.cost_part_count()) {
                    throw std::invalid_argument("there must be one price for each action and for each cost part");
                }
                new (self) relax::PricedProblem(problem, {std::move(actions), std::move(parts)});
            },
            "problem"_a, "actions"_a, "parts"_a, nb::keep_alive<1, 2>());
}
