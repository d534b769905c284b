#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <string_view>
#include <vector>

#include "bindings.hpp"
#include "relax/heuristics/heuristic.hpp"
#include "relax/search/search_options.hpp"

namespace nb = nanobind;

namespace {

// A heuristic is a name in Python.
template <typename Options>
void def_heuristic(nb::class_<Options>& options) {
    options.def_prop_rw(
        "heuristic", [](const Options& self) { return self.heuristic->name; },
        [](Options& self, std::string_view name) { self.heuristic = &relax::heuristic_named(name); });
}

template <typename Options>
void def_progression_switches(nb::class_<Options>& options) {
    options.def_rw("skip_dead_methods", &Options::skip_dead_methods)
        .def_rw("stubborn_sets", &Options::stubborn_sets)
        .def_rw("forget_facts", &Options::forget_facts);
}

std::vector<std::string_view> names(const relax::FindPlansOptions& options) {
    std::vector<std::string_view> names;
    for (const relax::HeuristicInfo* const heuristic : options.heuristics) {
        names.push_back(heuristic->name);
    }
    return names;
}

void set_names(relax::FindPlansOptions& options, const std::vector<std::string>& names) {
    options.heuristics.clear();
    for (const std::string& name : names) {
        options.heuristics.push_back(&relax::heuristic_named(name));
    }
}

}  // namespace

void bind_search_options(nb::module_& module) {
    nb::class_<relax::HeuristicInfo>(module, "HeuristicInfo")
        .def_ro("name", &relax::HeuristicInfo::name)
        .def_ro("description", &relax::HeuristicInfo::description)
        .def_ro("admissible", &relax::HeuristicInfo::is_admissible)
        .def_ro("consistent", &relax::HeuristicInfo::is_consistent)
        .def_ro("safe", &relax::HeuristicInfo::is_safe);
    module.def("heuristics", [] {
        const auto all = relax::heuristics();
        return std::vector<relax::HeuristicInfo>(all.begin(), all.end());
    });

    auto find_plans = nb::class_<relax::FindPlansOptions>(module, "FindPlansOptions")
                          .def(nb::init<>())
                          .def_prop_rw("heuristics", &names, &set_names)
                          .def_rw("weight", &relax::FindPlansOptions::weight)
                          .def_rw("upper_bound", &relax::FindPlansOptions::upper_bound)
                          .def_rw("tdg_bound", &relax::FindPlansOptions::tdg_bound)
                          .def_rw("inherit_h", &relax::FindPlansOptions::inherit_h)
                          .def_rw("selective", &relax::FindPlansOptions::selective)
                          .def_rw("endings", &relax::FindPlansOptions::endings)
                          .def_rw("merge_sequences", &relax::FindPlansOptions::merge_sequences)
                          .def_rw("learn_branching", &relax::FindPlansOptions::learn_branching)
                          .def_rw("follow_forced", &relax::FindPlansOptions::follow_forced);
    def_progression_switches(find_plans);

    auto greedy = nb::class_<relax::GreedyOptions>(module, "GreedyOptions")
                      .def(nb::init<>())
                      .def_rw("upper_bound", &relax::GreedyOptions::upper_bound)
                      .def_rw("in_sequence", &relax::GreedyOptions::in_sequence)
                      .def_rw("when_due", &relax::GreedyOptions::when_due)
                      .def_rw("explores", &relax::GreedyOptions::explores)
                      .def_rw("most_evaluations", &relax::GreedyOptions::most_evaluations);
    def_heuristic(greedy);
    def_progression_switches(greedy);

    auto plan_based = nb::class_<relax::PlanBasedOptions>(module, "PlanBasedOptions")
                          .def(nb::init<>())
                          .def_rw("upper_bound", &relax::PlanBasedOptions::upper_bound)
                          .def_rw("tolerance", &relax::PlanBasedOptions::tolerance)
                          .def_rw("branches_over_all", &relax::PlanBasedOptions::branches_over_all)
                          .def_rw("checks_preconditions", &relax::PlanBasedOptions::checks_preconditions);
    def_heuristic(plan_based);

    nb::class_<relax::PortfolioOptions>(module, "PortfolioOptions")
        .def(nb::init<>())
        .def_rw("members", &relax::PortfolioOptions::members)
        .def_rw("upper_bound", &relax::PortfolioOptions::upper_bound);

    nb::enum_<relax::Distinct>(module, "Distinct")
        .value("Sequence", relax::Distinct::Sequence)
        .value("Multiset", relax::Distinct::Multiset);

    auto label_search = nb::class_<relax::LabelSearchOptions>(module, "LabelSearchOptions")
                            .def(nb::init<>())
                            .def_rw("count", &relax::LabelSearchOptions::count)
                            .def_rw("distinct", &relax::LabelSearchOptions::distinct)
                            .def_rw("upper_bound", &relax::LabelSearchOptions::upper_bound)
                            .def_rw("tolerance", &relax::LabelSearchOptions::tolerance)
                            .def_rw("tdg_bound", &relax::LabelSearchOptions::tdg_bound)
                            .def_rw("inherit_h", &relax::LabelSearchOptions::inherit_h)
                            .def_rw("follow_forced", &relax::LabelSearchOptions::follow_forced)
                            .def_rw("selective", &relax::LabelSearchOptions::selective)
                            .def_rw("limits_labels", &relax::LabelSearchOptions::limits_labels);
    def_heuristic(label_search);
    def_progression_switches(label_search);
}
