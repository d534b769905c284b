#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "id_caster.hpp"
#include "python_limits.hpp"
#include "relax/policies/explicit_source.hpp"
#include "relax/policies/policy_search.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

// (constant, cost, outcomes as (successor, weight))
using GivenDecision = std::tuple<double, double, std::vector<std::pair<std::uint32_t, double>>>;
// (is done, lower worth at first, lower worth at a closer look, worth of stopping, decisions)
using GivenNode = std::tuple<bool, double, double, double, std::vector<GivenDecision>>;
using Policy = std::vector<std::pair<std::uint32_t, std::optional<std::uint32_t>>>;

std::vector<relax::ExplicitNode> explicit_nodes(const std::vector<GivenNode>& given) {
    std::vector<relax::ExplicitNode> nodes;
    for (const auto& [is_done, first_lower, lower, stop, decisions] : given) {
        relax::ExplicitNode& node = nodes.emplace_back(relax::ExplicitNode{is_done, first_lower, lower, stop, {}});
        for (const auto& [constant, cost, outcomes] : decisions) {
            relax::DraftDecision& decision = node.decisions.emplace_back();
            decision.constant = constant;
            decision.cost = cost;
            for (const auto& [successor, weight] : outcomes) {
                decision.successors.emplace_back(successor);
                decision.weights.push_back(weight);
            }
        }
    }
    return nodes;
}

// Search a graph that is given as a whole. Returns the result, and the policy by numbers of nodes: the index of the
// decision, or none where it stops.
std::pair<relax::PolicySearchResult, Policy> solve(const std::vector<GivenNode>& nodes, std::uint32_t root,
                                                   const relax::PolicySearchOptions& options,
                                                   std::optional<double> seconds,
                                                   std::optional<std::size_t> memory_bytes,
                                                   std::optional<std::uint64_t> steps) {
    relax::ExplicitSource source(explicit_nodes(nodes), root);
    relax::Limits limits = python_limits(seconds, memory_bytes, steps);
    const nb::gil_scoped_release no_gil;
    relax::PolicyStatistics statistics;
    relax::PolicySearch search(source, options, limits, statistics);
    relax::PolicySearchResult result = search.run();
    Policy policy;
    if (result.policy) {
        for (std::size_t at = 0; at < result.policy->nodes.size(); ++at) {
            const relax::PolicyNodeId node = result.policy->nodes[at];
            const relax::DecisionId choice = result.policy->choices[at];
            policy.emplace_back(source.number_of(node), choice == relax::kStop
                                                            ? std::nullopt
                                                            : std::optional(choice - search.graph()[node].first));
        }
    }
    return {std::move(result), std::move(policy)};
}

}  // namespace

void bind_policies(nb::module_& module) {
    nb::enum_<relax::Recursion>(module, "Recursion")
        .value("Expected", relax::Recursion::Expected)
        .value("Averse", relax::Recursion::Averse)
        .value("Seeking", relax::Recursion::Seeking)
        .value("LogExpected", relax::Recursion::LogExpected);

    nb::class_<relax::PolicySearchOptions>(module, "PolicySearchOptions")
        .def(nb::init<>())
        .def_rw("recursion", &relax::PolicySearchOptions::recursion)
        .def_rw("precision", &relax::PolicySearchOptions::precision)
        .def_rw("unit", &relax::PolicySearchOptions::unit)
        .def_rw("breaks_ties", &relax::PolicySearchOptions::breaks_ties);

    nb::class_<relax::PolicyStatistics>(module, "PolicyStatistics")
        .def_ro("expanded", &relax::PolicyStatistics::expanded)
        .def_ro("generated", &relax::PolicyStatistics::generated)
        .def_ro("evaluated", &relax::PolicyStatistics::evaluated)
        .def_ro("dead_ends", &relax::PolicyStatistics::dead_ends)
        .def_ro("rounds", &relax::PolicyStatistics::rounds)
        .def_ro("iterations", &relax::PolicyStatistics::iterations)
        .def_ro("lower", &relax::PolicyStatistics::lower)
        .def_ro("upper", &relax::PolicyStatistics::upper)
        .def_ro("cost", &relax::PolicyStatistics::cost);

    nb::class_<relax::PolicySearchResult>(module, "PolicySearchResult")
        .def_ro("stop", &relax::PolicySearchResult::stop)
        .def_ro("statistics", &relax::PolicySearchResult::statistics)
        .def_ro("is_infinite", &relax::PolicySearchResult::is_infinite)
        .def_ro("is_undecided", &relax::PolicySearchResult::is_undecided);

    module.def("solve_decision_graph", &solve, "nodes"_a, "root"_a, "options"_a, "seconds"_a = nb::none(),
               "memory_bytes"_a = nb::none(), "steps"_a = nb::none());
}
