#include <nanobind/nanobind.h>

#include "bindings.hpp"
#include "relax/base/worth.hpp"
#include "relax/valuations/price_sums.hpp"
#include "relax/valuations/valuation.hpp"

namespace nb = nanobind;
using namespace nb::literals;

void bind_valuations(nb::module_& module) {
    module.def("order_of", &relax::order_of, "value"_a);
    module.def("value_of", &relax::value_of, "order"_a);
    nb::class_<relax::Valuation>(module, "Valuation");
    nb::class_<relax::PriceSums, relax::Valuation>(module, "PriceSums")
        .def(nb::init<const relax::PricedProblem&>(), "priced"_a, nb::keep_alive<1, 2>());
}
