#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "id_caster.hpp"
#include "python_limits.hpp"
#include "relax/valuations/budgets.hpp"
#include "relax/valuations/disutility_of_law.hpp"
#include "relax/valuations/evar.hpp"
#include "relax/valuations/expected_disutility.hpp"
#include "relax/valuations/law_orders.hpp"
#include "relax/valuations/law_valuation.hpp"
#include "relax/valuations/mean_cvar.hpp"
#include "relax/valuations/quantile.hpp"
#include "relax/valuations/tabulated_disutility.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using relax::LawId;
using relax::LawTable;
using Kinks = std::vector<std::tuple<double, double, double>>;
using Outcomes = std::pair<std::vector<double>, std::vector<double>>;

constexpr double kNoBound = std::numeric_limits<double>::infinity();

Outcomes outcomes_of(const relax::Law& law) {
    return {{law.at.begin(), law.at.end()}, {law.probability.begin(), law.probability.end()}};
}

void bind_law_table(nb::module_& module) {
    nb::class_<LawTable>(module, "LawTable")
        .def(
            "__init__",
            [](LawTable* self, double last, bool is_flat_beyond, std::optional<std::size_t> most_outcomes,
               bool keeps_means) {
                new (self) LawTable({last, is_flat_beyond, most_outcomes.value_or(relax::kAnyNumber), keeps_means});
            },
            "last"_a = kNoBound, "is_flat_beyond"_a = false, "most_outcomes"_a = nb::none(), "keeps_means"_a = false)
        .def(
            "add",
            [](LawTable& self, const std::vector<double>& at, const std::vector<double>& probabilities) {
                if (at.empty() || at.size() != probabilities.size()) {
                    throw std::invalid_argument("there must be one probability for each outcome");
                }
                return self.add(at, probabilities);
            },
            "at"_a, "probabilities"_a)
        .def(
            "sum",
            [](LawTable& self, LawId one, LawId other) {
                relax::Limits limits;
                return self.sum(one, other, limits);
            },
            "one"_a, "other"_a)
        .def(
            "outcomes", [](const LawTable& self, LawId law) { return outcomes_of(self[law]); }, "law"_a)
        .def(
            "is_never_more",
            [](const LawTable& self, LawId one, LawId other, double until) {
                return relax::is_never_more(self[one], self[other], until);
            },
            "one"_a, "other"_a, "until"_a = kNoBound)
        .def(
            "has_no_larger_excess",
            [](const LawTable& self, LawId one, LawId other, double until) {
                return relax::has_no_larger_excess(self[one], self[other], until);
            },
            "one"_a, "other"_a, "until"_a = kNoBound);
}

void bind_objectives(nb::module_& module) {
    using relax::LawObjective;
    nb::class_<LawObjective>(module, "LawObjective")
        .def_prop_ro("last", [](const LawObjective& self) { return self.detail().last; })
        .def_prop_ro("is_flat_beyond", [](const LawObjective& self) { return self.detail().is_flat_beyond; })
        .def_prop_ro("is_concave", &LawObjective::is_concave)
        .def(
            "value", [](const LawObjective& self, const LawTable& table, LawId law) { return self.value(table[law]); },
            "table"_a, "law"_a)
        .def(
            "bound",
            [](const LawObjective& self, const LawTable& table, LawId law, double more) {
                return self.bound(table[law], more);
            },
            "table"_a, "law"_a, "more"_a)
        .def(
            "bound_of_sum",
            [](const LawObjective& self, const LawTable& table, LawId law, const LawTable& other_table, LawId other,
               double floor) {
                relax::FlooredLaw floored(other_table[other], floor);
                return self.bound_of_sum(table[law], floored);
            },
            "table"_a, "law"_a, "other_table"_a, "other"_a, "floor"_a);

    nb::class_<relax::ExpectedDisutility, LawObjective>(module, "ExpectedDisutility")
        .def(
            "__init__",
            [](relax::ExpectedDisutility* self, double base, double slope, const Kinks& kinks) {
                if (kinks.empty()) {
                    throw std::invalid_argument("there must be a kink");
                }
                relax::PiecewiseDisutility disutility{base, slope, {}};
                for (const auto& [at, jump, rise] : kinks) {
                    disutility.kinks.push_back({at, jump, rise});
                }
                new (self) relax::ExpectedDisutility(std::move(disutility));
            },
            "base"_a, "slope"_a, "kinks"_a);
    nb::class_<relax::TabulatedDisutility, LawObjective>(module, "TabulatedDisutility")
        .def(nb::init<std::vector<double>>(), "table"_a);
    nb::class_<relax::QuantileOfLaw, LawObjective>(module, "QuantileOfLaw")
        .def(nb::init<double, double>(), "level"_a, "step"_a);
    nb::class_<relax::MeanCvarOfLaw, LawObjective>(module, "MeanCvarOfLaw")
        .def(nb::init<double, double, double>(), "level"_a, "weight"_a, "step"_a);
    nb::class_<relax::DisutilityOfLaw, LawObjective>(module, "DisutilityOfLaw")
        .def(
            "__init__",
            [](relax::DisutilityOfLaw* self, double linear, const std::vector<std::pair<double, double>>& terms,
               double step) {
                if (!(linear >= 0) || (linear == 0 && terms.empty())) {
                    throw std::invalid_argument("there must be a term, and no negative weight");
                }
                std::vector<relax::ExponentialTerm> exponentials;
                for (const auto& [slope, log_weight] : terms) {
                    exponentials.push_back({slope, log_weight});
                }
                new (self) relax::DisutilityOfLaw(linear, std::move(exponentials), step);
            },
            "linear"_a, "terms"_a, "step"_a);
    nb::class_<relax::EvarOfLaw, LawObjective>(module, "EvarOfLaw")
        .def(nb::init<double, double>(), "level"_a, "step"_a);
}

void bind_law_valuation(nb::module_& module) {
    nb::class_<relax::CostLaws>(module, "CostLaws")
        .def(
            "__init__",
            [](relax::CostLaws* self, const std::vector<Outcomes>& laws, std::vector<std::uint32_t> actions,
               std::vector<std::uint32_t> parts) {
                new (self) relax::CostLaws{{}, std::move(actions), std::move(parts)};
                for (const auto& [at, probabilities] : laws) {
                    self->laws.push_back({at, probabilities});
                }
            },
            "laws"_a, "actions"_a, "parts"_a);

    using relax::LawOptions;
    nb::class_<LawOptions>(module, "LawOptions")
        .def(nb::init<>())
        .def_rw("stochastic_order", &LawOptions::stochastic_order)
        .def_rw("convex_order", &LawOptions::convex_order)
        .def_rw("pairwise", &LawOptions::pairwise)
        .def_rw("least_bound", &LawOptions::least_bound)
        .def_rw("mean_bound", &LawOptions::mean_bound)
        .def_rw("graph_bound", &LawOptions::graph_bound)
        .def_rw("graph_parts", &LawOptions::graph_parts)
        .def_rw("label_outcomes", &LawOptions::label_outcomes)
        .def_rw("graph_outcomes", &LawOptions::graph_outcomes)
        .def_rw("network_outcomes", &LawOptions::network_outcomes);

    module.def(
        "is_as_good",
        [](const relax::LawObjective& objective, const LawTable& table, LawId one, LawId other, double least,
           const LawOptions& options) {
            return relax::is_as_good(objective, options, table[one], table[other], least);
        },
        "objective"_a, "table"_a, "one"_a, "other"_a, "least"_a, "options"_a);

    using relax::LawValuation;
    nb::class_<LawValuation, relax::Valuation>(module, "LawValuation")
        .def(nb::init<const relax::PricedProblem&, const relax::PricedProblem&, double, const relax::CostLaws&,
                      std::shared_ptr<const relax::LawObjective>, const LawOptions&>(),
             "least"_a, "means"_a, "units_per_step"_a, "costs"_a, "objective"_a, "options"_a, nb::keep_alive<1, 2>(),
             nb::keep_alive<1, 3>())
        .def(
            "law", [](const LawValuation& self, relax::ValueId value) { return outcomes_of(self.law(value)); },
            "value"_a)
        .def_prop_ro("is_exact", &LawValuation::is_exact)
        .def(
            "law_of_task",
            [](LawValuation& self, relax::TaskId task) {
                relax::Limits limits;
                return outcomes_of(self.law_of_task(task, limits));
            },
            "task"_a);
}

void bind_budgets(nb::module_& module) {
    nb::class_<relax::Budgets, relax::Valuation>(module, "Budgets")
        .def(
            "__init__",
            [](relax::Budgets* self, relax::Valuation& inner, const relax::PricedProblem& least,
               const relax::CostLaws& costs, const std::vector<std::pair<double, double>>& budgets,
               const relax::LawOptions& options) {
                if (budgets.empty()) {
                    throw std::invalid_argument("there must be a budget");
                }
                std::vector<relax::Budget> kept;
                for (const auto& [steps, probability] : budgets) {
                    kept.push_back({steps, probability});
                }
                new (self) relax::Budgets(inner, least, costs, std::move(kept), options);
            },
            "inner"_a, "least"_a, "costs"_a, "budgets"_a, "options"_a, nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>());
}

}  // namespace

void bind_laws(nb::module_& module) {
    bind_law_table(module);
    bind_objectives(module);
    bind_law_valuation(module);
    bind_budgets(module);
}
