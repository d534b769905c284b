#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "id_caster.hpp"
#include "python_limits.hpp"
#include "relax/analysis/priced_problem.hpp"
#include "relax/search/top_plans.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

relax::TopPlansResult top_plans(const relax::PricedProblem& priced, std::vector<std::optional<relax::ActionName>> names,
                                const relax::TopPlansOptions& options, std::optional<double> seconds,
                                std::optional<std::size_t> memory_bytes, std::optional<std::uint64_t> steps,
                                const nb::object& progress) {
    if (names.size() != priced.problem.action_count()) {
        throw std::invalid_argument("there must be one name, or none, for each action");
    }
    if (!options.heuristic->is_admissible) {
        throw std::invalid_argument("the heuristic must be admissible");
    }
    relax::TopPlansStatistics statistics;
    std::function<void()> watch;
    if (!progress.is_none()) {
        watch = [&] { progress(statistics); };
    }
    relax::Limits limits = python_limits(seconds, memory_bytes, steps, std::move(watch));
    const nb::gil_scoped_release no_gil;
    return relax::top_plans(priced, std::move(names), options, limits, statistics);
}

}  // namespace

void bind_top_plans(nb::module_& module) {
    nb::class_<relax::TopPlansStatistics, relax::SearchStatistics>(module, "TopPlansStatistics")
        .def_ro("found", &relax::TopPlansStatistics::found)
        .def_ro("proven", &relax::TopPlansStatistics::proven);

    nb::class_<relax::TopPlansResult>(module, "TopPlansResult")
        .def_ro("stop", &relax::TopPlansResult::stop)
        .def_ro("is_all", &relax::TopPlansResult::is_all)
        .def_ro("statistics", &relax::TopPlansResult::statistics)
        .def_ro("plans", &relax::TopPlansResult::plans);

    module.def("top_plans", &top_plans, "priced"_a, "names"_a, "options"_a, "seconds"_a = nb::none(),
               "memory_bytes"_a = nb::none(), "steps"_a = nb::none(), "progress"_a = nb::none());
}
