#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "relax/valuations/scenario_laws.hpp"
#include "relax/valuations/scenario_totals.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using relax::PricedProblem;
using relax::ScenarioBudget;
using relax::ScenarioCosts;
using relax::ScenarioOptions;
using relax::ScenarioTangent;
using Objective = std::shared_ptr<const relax::LawObjective>;
using Tangents = std::vector<std::tuple<const PricedProblem*, double, double, std::vector<double>>>;
using Budgets = std::vector<std::pair<Objective, double>>;
using Scenarios = std::vector<std::tuple<double, const PricedProblem*, relax::CostLaws>>;

std::vector<ScenarioTangent> tangents_of(Tangents given, std::size_t scenarios) {
    if (given.empty() || scenarios == 0) {
        throw std::invalid_argument("there must be a scenario and a tangent");
    }
    std::vector<ScenarioTangent> tangents;
    for (auto& [priced, units, constant, weights] : given) {
        if (weights.size() != scenarios) {
            throw std::invalid_argument("there must be one weight for each scenario");
        }
        tangents.push_back({priced, units, constant, std::move(weights)});
    }
    return tangents;
}

std::vector<ScenarioBudget> budgets_of(const Budgets& given) {
    std::vector<ScenarioBudget> budgets;
    for (const auto& [deadline, most] : given) {
        budgets.push_back({deadline, most});
    }
    return budgets;
}

}  // namespace

void bind_scenarios(nb::module_& module) {
    nb::class_<ScenarioOptions>(module, "ScenarioOptions")
        .def(nb::init<>())
        .def_rw("compare_scenarios", &ScenarioOptions::compare_scenarios)
        .def_rw("decided_scenarios", &ScenarioOptions::decided_scenarios)
        .def_rw("ideal_bound", &ScenarioOptions::ideal_bound)
        .def_rw("tangent_bound", &ScenarioOptions::tangent_bound);

    nb::class_<relax::ScenarioTotals, relax::Valuation>(module, "ScenarioTotals")
        .def(
            "__init__",
            [](relax::ScenarioTotals* self, std::vector<const PricedProblem*> prices, std::vector<double> probabilities,
               Tangents tangents, bool asks_scenarios, Objective objective, const Budgets& budgets,
               const ScenarioOptions& options) {
                if (probabilities.size() != prices.size()) {
                    throw std::invalid_argument("there must be one probability for each scenario");
                }
                auto lines = tangents_of(std::move(tangents), prices.size());
                new (self) relax::ScenarioTotals(std::move(prices), std::move(probabilities), std::move(lines),
                                                 asks_scenarios, std::move(objective), budgets_of(budgets), options);
            },
            "prices"_a, "probabilities"_a, "tangents"_a, "asks_scenarios"_a, "objective"_a, "budgets"_a, "options"_a,
            nb::keep_alive<1, 2>(), nb::keep_alive<1, 4>());

    nb::class_<relax::ScenarioLaws, relax::Valuation>(module, "ScenarioLaws")
        .def(
            "__init__",
            [](relax::ScenarioLaws* self, Scenarios scenarios, Tangents tangents, bool asks_scenarios,
               Objective objective, const Budgets& budgets, const ScenarioOptions& options,
               const relax::LawOptions& law_options) {
                std::vector<ScenarioCosts> costs;
                for (auto& [probability, least, laws] : scenarios) {
                    costs.push_back({probability, least, std::move(laws)});
                }
                auto lines = tangents_of(std::move(tangents), costs.size());
                new (self) relax::ScenarioLaws(std::move(costs), std::move(lines), asks_scenarios, std::move(objective),
                                               budgets_of(budgets), options, law_options);
            },
            "scenarios"_a, "tangents"_a, "asks_scenarios"_a, "objective"_a, "budgets"_a, "options"_a, "law_options"_a,
            nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>());
}
