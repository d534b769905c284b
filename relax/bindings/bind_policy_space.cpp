#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "id_caster.hpp"
#include "node_contents.hpp"
#include "python_limits.hpp"
#include "relax/progression/policy_space.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Outcome = std::tuple<std::uint32_t, std::optional<relax::ActionId>, std::vector<relax::CostPartId>>;
using Decision = std::tuple<std::uint32_t, std::optional<relax::MethodId>, std::vector<Outcome>>;

// The whole space of a problem, and the progression that its nodes are of.
class Space {
public:
    Space(const relax::AnalysedProblem& problem, const std::vector<bool>& free_actions,
          const std::vector<bool>& seen_actions, const std::vector<bool>& seen_parts, bool skip_dead_methods,
          bool stubborn_sets, bool forget_facts, bool forget_unreachable, bool lone_members, bool only_done_runs_pay,
          std::size_t most_nodes, std::optional<double> seconds, std::optional<std::size_t> memory_bytes,
          std::optional<std::uint64_t> steps)
        : problem_(problem), limits_(python_limits(seconds, memory_bytes, steps)) {
        const relax::SeenCosts seen{seen_actions, seen_parts};
        check_entries(problem, free_actions, seen);
        const nb::gil_scoped_release no_gil;
        stop_ = relax::run_within_limits([&] {
            progression_.emplace(
                problem, free_actions, seen,
                relax::PolicyOptions{{skip_dead_methods, stubborn_sets, forget_facts, forget_unreachable, lone_members},
                                     only_done_runs_pay},
                limits_);
            space_.emplace(*progression_, most_nodes, limits_);
            return space_->stop();
        });
    }

    std::optional<relax::StopReason> stop() const { return stop_; }
    std::size_t node_count() const { return space_ ? space_->node_count() : 0; }
    std::size_t expanded_count() const { return space_ ? space_->expanded_count() : 0; }

    std::optional<double> most_cost(const std::vector<double>& actions, const std::vector<double>& parts) const {
        if (!space_ || space_->expanded_count() < space_->node_count()) {
            throw std::out_of_range("the space is not complete");
        }
        if (actions.size() != problem_.action_count() || parts.size() != problem_.cost_part_count()) {
            throw std::invalid_argument("there must be one cost for each action, and for each part");
        }
        return space_->most_cost({actions, parts});
    }

    std::vector<relax::FactId> facts(std::uint32_t node) const {
        check(node, node_count());
        return facts_in(progression_->states()[space_->state(node)]);
    }
    std::vector<relax::TaskId> tasks(std::uint32_t node) {
        check(node, node_count());
        return progression_->ordered_tasks(space_->network(node)).tasks;
    }
    // Pairs of indices into the tasks; transitively closed.
    OrderedPairs ordering(std::uint32_t node) {
        check(node, node_count());
        return ordered_pairs(progression_->ordered_tasks(space_->network(node)));
    }
    std::vector<Decision> decisions(std::uint32_t node) const {
        check(node, expanded_count());
        std::vector<Decision> decisions;
        for (const relax::PolicySpace::Decision& one : space_->decisions(node)) {
            std::vector<Outcome> outcomes;
            for (const relax::PolicySpace::Outcome& outcome : one.outcomes) {
                outcomes.emplace_back(outcome.node, outcome.action, outcome.due_parts);
            }
            decisions.emplace_back(one.step.occurrence, one.step.method, std::move(outcomes));
        }
        return decisions;
    }

private:
    static void check(std::size_t node, std::size_t count) {
        if (node >= count) {
            throw std::out_of_range("index out of range");
        }
    }

    const relax::AnalysedProblem& problem_;
    relax::Limits limits_;
    std::optional<relax::PolicyProgression> progression_;
    std::optional<relax::PolicySpace> space_;
    std::optional<relax::StopReason> stop_;
};

}  // namespace

void bind_policy_space(nb::module_& module) {
    nb::class_<Space>(module, "PolicySpace")
        .def(nb::init<const relax::AnalysedProblem&, const std::vector<bool>&, const std::vector<bool>&,
                      const std::vector<bool>&, bool, bool, bool, bool, bool, bool, std::size_t, std::optional<double>,
                      std::optional<std::size_t>, std::optional<std::uint64_t>>(),
             "problem"_a, "free_actions"_a, "seen_actions"_a = std::vector<bool>{},
             "seen_parts"_a = std::vector<bool>{}, "skip_dead_methods"_a = true, "stubborn_sets"_a = true,
             "forget_facts"_a = true, "forget_unreachable"_a = true, "lone_members"_a = true,
             "only_done_runs_pay"_a = false, "most_nodes"_a = std::size_t{1} << 20, "seconds"_a = nb::none(),
             "memory_bytes"_a = nb::none(), "steps"_a = nb::none(), nb::keep_alive<1, 2>())
        .def_prop_ro("stop", &Space::stop)
        .def_prop_ro("node_count", &Space::node_count)
        .def_prop_ro("expanded_count", &Space::expanded_count)
        .def("most_cost", &Space::most_cost, "actions"_a, "parts"_a)
        .def("facts", &Space::facts, "node"_a)
        .def("tasks", &Space::tasks, "node"_a)
        .def("ordering", &Space::ordering, "node"_a)
        .def("decisions", &Space::decisions, "node"_a);
}
