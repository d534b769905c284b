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
#include "relax/analysis/analysed_problem.hpp"
#include "relax/search/label_search.hpp"
#include "relax/search/plan_based.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

// Run one of the searches by a valuation.
template <typename Search>
relax::LabelSearchResult run(const relax::AnalysedProblem& problem, const relax::Valuation& valuation,
                             const relax::HeuristicInfo& heuristic, std::optional<double> seconds,
                             std::optional<std::size_t> memory_bytes, std::optional<std::uint64_t> steps,
                             const nb::object& progress, Search search) {
    if (!heuristic.is_admissible) {
        throw std::invalid_argument("the heuristic must be admissible");
    }
    for (const relax::PricedProblem* const priced : valuation.prices()) {
        if (&priced->problem != &problem) {
            throw std::invalid_argument("the valuation must be of this problem");
        }
    }
    relax::LabelStatistics statistics;
    std::function<void()> watch;
    if (!progress.is_none()) {
        watch = [&] { progress(statistics); };
    }
    relax::Limits limits = python_limits(seconds, memory_bytes, steps, std::move(watch));
    const nb::gil_scoped_release no_gil;
    return search(limits, statistics);
}

relax::LabelSearchResult label_search(const relax::AnalysedProblem& problem, relax::Valuation& valuation,
                                      const std::vector<std::optional<relax::ActionName>>& names,
                                      const relax::LabelSearchOptions& options, std::optional<double> seconds,
                                      std::optional<std::size_t> memory_bytes, std::optional<std::uint64_t> steps,
                                      const nb::object& progress) {
    if (names.size() != problem.action_count()) {
        throw std::invalid_argument("there must be one name, or none, for each action");
    }
    return run(problem, valuation, *options.heuristic, seconds, memory_bytes, steps, progress,
               [&](relax::Limits& limits, relax::LabelStatistics& statistics) {
                   return relax::label_search(problem, valuation, names, options, limits, statistics);
               });
}

relax::LabelSearchResult plan_based_search(const relax::AnalysedProblem& problem, relax::Valuation& valuation,
                                           const relax::PlanBasedOptions& options, std::optional<double> seconds,
                                           std::optional<std::size_t> memory_bytes, std::optional<std::uint64_t> steps,
                                           const nb::object& progress) {
    return run(problem, valuation, *options.heuristic, seconds, memory_bytes, steps, progress,
               [&](relax::Limits& limits, relax::LabelStatistics& statistics) {
                   return relax::plan_based_search(problem, valuation, options, limits, statistics);
               });
}

}  // namespace

void bind_label_search(nb::module_& module) {
    nb::class_<relax::LabelStatistics, relax::SearchStatistics>(module, "LabelStatistics")
        .def_ro("found", &relax::LabelStatistics::found)
        .def_ro("proven", &relax::LabelStatistics::proven);

    nb::class_<relax::LabelSearchResult>(module, "LabelSearchResult")
        .def_ro("stop", &relax::LabelSearchResult::stop)
        .def_ro("is_all", &relax::LabelSearchResult::is_all)
        .def_ro("statistics", &relax::LabelSearchResult::statistics)
        .def_ro("plans", &relax::LabelSearchResult::plans)
        .def_ro("worths", &relax::LabelSearchResult::worths);

    module.def("label_search", &label_search, "problem"_a, "valuation"_a, "names"_a, "options"_a,
               "seconds"_a = nb::none(), "memory_bytes"_a = nb::none(), "steps"_a = nb::none(),
               "progress"_a = nb::none());
    module.def("plan_based_search", &plan_based_search, "problem"_a, "valuation"_a, "options"_a,
               "seconds"_a = nb::none(), "memory_bytes"_a = nb::none(), "steps"_a = nb::none(),
               "progress"_a = nb::none());
}
