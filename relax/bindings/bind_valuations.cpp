#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "id_caster.hpp"
#include "relax/base/worth.hpp"
#include "relax/valuations/exponential_sums.hpp"
#include "relax/valuations/finite_options.hpp"
#include "relax/valuations/mean_deviation.hpp"
#include "relax/valuations/price_mix.hpp"
#include "relax/valuations/price_sums.hpp"
#include "relax/valuations/valuation.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Least = std::vector<relax::Cost>;
using Options = relax::FiniteOptions;
using Mixes = std::vector<std::pair<const relax::PricedProblem*, std::vector<double>>>;

// What is known of a node, by the valuation's prices; its network is the initial one.
relax::CostToCome to_come(const relax::Valuation& valuation, const Least& least) {
    if (least.size() != valuation.prices().size()) {
        throw std::invalid_argument("there must be one bound for each vector of prices");
    }
    return {relax::NetworkId{0}, least};
}

std::vector<relax::PriceMix> price_mixes(Mixes mixes, std::size_t prices) {
    std::vector<relax::PriceMix> made;
    for (auto& [priced, weights] : mixes) {
        if (weights.size() != prices) {
            throw std::invalid_argument("there must be one weight for each vector of prices");
        }
        made.push_back({priced, std::move(weights)});
    }
    return made;
}

void bind_exponential_sums(nb::module_& module) {
    nb::class_<relax::ExponentialSums, relax::Valuation>(module, "ExponentialSums")
        .def(
            "__init__",
            [](relax::ExponentialSums* self, std::vector<const relax::PricedProblem*> prices,
               std::vector<int> exponents, double linear, const std::vector<std::pair<double, double>>& terms,
               Mixes mixes, const Options& options) {
                const std::size_t size = prices.size();
                if (size == 0 || exponents.size() != size || terms.size() + (linear > 0 ? 1 : 0) != size) {
                    throw std::invalid_argument("there must be one vector of prices, and one unit, for each term");
                }
                std::vector<relax::ExponentialTerm> exponentials;
                for (const auto& [slope, log_weight] : terms) {
                    exponentials.push_back({slope, log_weight});
                }
                new (self)
                    relax::ExponentialSums(std::move(prices), std::move(exponents), linear, std::move(exponentials),
                                           price_mixes(std::move(mixes), size), options);
            },
            "prices"_a, "exponents"_a, "linear"_a, "terms"_a, "mixes"_a, "options"_a, nb::keep_alive<1, 2>(),
            nb::keep_alive<1, 6>());
}

void bind_mean_deviation(nb::module_& module) {
    nb::class_<relax::MeanDeviation, relax::Valuation>(module, "MeanDeviation")
        .def(
            "__init__",
            [](relax::MeanDeviation* self, double weight, const relax::PricedProblem& means,
               const relax::PricedProblem& variances, int mean_exponent, int variance_exponent, Mixes mixes,
               const Options& options) {
                new (self) relax::MeanDeviation(weight, {&means, &variances}, {mean_exponent, variance_exponent},
                                                price_mixes(std::move(mixes), 2), options);
            },
            "weight"_a, "means"_a, "variances"_a, "mean_exponent"_a, "variance_exponent"_a, "mixes"_a, "options"_a,
            nb::keep_alive<1, 3>(), nb::keep_alive<1, 4>(), nb::keep_alive<1, 7>());
}

}  // namespace

void bind_valuations(nb::module_& module) {
    module.def("order_of", &relax::order_of, "value"_a);
    module.def("value_of", &relax::value_of, "order"_a);

    using relax::Valuation;
    using relax::ValueId;
    nb::class_<Valuation>(module, "Valuation")
        .def("start", &Valuation::start)
        .def(
            "extend",
            [](Valuation& self, ValueId value, relax::ActionId action,
               const std::vector<relax::CostPartId>& due_parts) { return self.extend(value, action, due_parts); },
            "value"_a, "action"_a, "due_parts"_a)
        .def("worth", &Valuation::worth, "value"_a)
        .def(
            "bound",
            [](Valuation& self, ValueId value, const Least& least, std::uint32_t stage) {
                return self.bound(value, to_come(self, least), stage);
            },
            "value"_a, "least"_a, "stage"_a = 0)
        .def(
            "are_as_good",
            [](Valuation& self, const std::vector<ValueId>& ways, ValueId other, const Least& least) {
                return self.are_as_good(ways, other, to_come(self, least));
            },
            "ways"_a, "other"_a, "least"_a)
        .def("set_cutoff", &Valuation::set_cutoff, "cutoff"_a);

    nb::class_<relax::PriceSums, Valuation>(module, "PriceSums")
        .def(nb::init<const relax::PricedProblem&>(), "priced"_a, nb::keep_alive<1, 2>());
    nb::class_<Options>(module, "FiniteOptions")
        .def(nb::init<>())
        .def_rw("bound_mixes", &Options::bound_mixes)
        .def_rw("compare_boxes", &Options::compare_boxes)
        .def_rw("compare_envelopes", &Options::compare_envelopes)
        .def_rw("use_cutoff", &Options::use_cutoff);
    bind_exponential_sums(module);
    bind_mean_deviation(module);
}
