#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "bindings.hpp"
#include "id_caster.hpp"
#include "python_limits.hpp"
#include "relax/analysis/priced_problem.hpp"
#include "relax/base/cost.hpp"
#include "relax/networks/ordered_tasks.hpp"
#include "relax/networks/totally_ordered_networks.hpp"
#include "relax/problem/state.hpp"
#include "relax/search/search.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Ordering = std::vector<std::pair<std::size_t, std::size_t>>;

// A heuristic on its own, for states and networks of the caller's choice.
class Evaluator {
public:
    Evaluator(const relax::PricedProblem& priced, std::string_view heuristic)
        : problem_(priced.problem),
          bounds_(priced.task_bounds(limits_)),
          heuristic_(relax::heuristic_named(heuristic).make(priced, limits_)) {}

    // `ordering`: pairs of places in `tasks`, transitively closed; none where nothing is known of the order. The
    // heuristic sees the order as in a search: in a totally ordered problem, as that of the tasks as they stand.
    std::optional<relax::Cost> evaluate(const std::vector<relax::FactId>& facts,
                                        const std::vector<relax::TaskId>& tasks,
                                        const std::optional<Ordering>& ordering) {
        relax::StateBits state(relax::StateTransition(problem_).word_count(), 0);
        for (const relax::FactId fact : facts) {
            if (fact >= problem_.fact_count()) {
                throw std::out_of_range("no such fact: " + std::to_string(fact));
            }
            relax::set_bit(state, fact);
        }
        relax::Cost bound = 0;
        for (const relax::TaskId task : tasks) {
            if (task >= problem_.task_count()) {
                throw std::out_of_range("no such task: " + std::to_string(task));
            }
            bound = relax::add_bounds(bound, bounds_[task]);
        }
        if (!ordering) {
            return heuristic_->evaluate({state, tasks, false, {}, bound});
        }
        relax::OrderedTasks network;
        network.reset(tasks.size());
        for (const auto& [earlier, later] : *ordering) {
            if (earlier >= tasks.size() || later >= tasks.size()) {
                throw std::out_of_range("no such place: " + std::to_string(std::max(earlier, later)));
            }
            network.put_before(earlier, later);
        }
        const bool stands_in_order =
            relax::TotallyOrderedNetworks::fits(problem_) &&
            ordering->size() == tasks.size() * (tasks.size() - 1) / 2 &&
            std::ranges::all_of(*ordering, [](const auto& pair) { return pair.first < pair.second; });
        return heuristic_->evaluate({state, tasks, stands_in_order, network.predecessors, bound});
    }

private:
    const relax::GroundProblem& problem_;
    relax::Limits limits_;  // none
    const std::vector<relax::Cost>& bounds_;
    std::unique_ptr<relax::Heuristic> heuristic_;
};

void check(const relax::HeuristicInfo& heuristic) {
    if (!heuristic.is_admissible) {
        throw std::invalid_argument("the heuristic must be admissible");
    }
}

void check(const relax::FindPlansOptions& options) {
    if (options.heuristics.empty()) {
        throw std::invalid_argument("there must be a heuristic");
    }
    for (const relax::HeuristicInfo* const heuristic : options.heuristics) {
        check(*heuristic);
    }
}

void check(const relax::GreedyOptions& /*options*/) {}

void check(const relax::PlanBasedOptions& options) { check(*options.heuristic); }

void check(const relax::PortfolioOptions& options) {
    for (const std::vector<relax::StepwiseOptions>& stages : options.members) {
        if (stages.empty()) {
            throw std::invalid_argument("each member of a portfolio must have a stage");
        }
        for (const relax::StepwiseOptions& stage : stages) {
            std::visit([](const auto& asked) { check(asked); }, stage);
        }
    }
    if (options.members.empty()) {
        throw std::invalid_argument("a portfolio must have members");
    }
}

relax::SearchResult find_plans(const relax::PricedProblem& priced, const relax::SearchOptions& options,
                               std::optional<double> seconds, std::optional<std::size_t> memory_bytes,
                               std::optional<std::uint64_t> steps, const nb::object& progress) {
    std::visit([](const auto& asked) { check(asked); }, options);
    relax::SearchStatistics statistics;
    std::function<void()> watch;
    if (!progress.is_none()) {
        watch = [&] { progress(statistics); };
    }
    relax::Limits limits = python_limits(seconds, memory_bytes, steps, std::move(watch));
    const nb::gil_scoped_release no_gil;
    return relax::search(priced, options, limits, statistics);
}

std::vector<relax::TaskId> executed_actions(const relax::SearchResult& result) {
    std::vector<relax::TaskId> actions;
    for (const std::uint32_t leaf : result.plan) {
        actions.push_back(result.decomposition[leaf].task);
    }
    return actions;
}

}  // namespace

void bind_find_plans(nb::module_& module) {
    nb::enum_<relax::SearchStatus>(module, "SearchStatus")
        .value("Optimal", relax::SearchStatus::Optimal)
        .value("Solved", relax::SearchStatus::Solved)
        .value("Unsolvable", relax::SearchStatus::Unsolvable)
        .value("GaveUp", relax::SearchStatus::GaveUp)
        .value("TimeLimit", relax::SearchStatus::TimeLimit)
        .value("MemoryLimit", relax::SearchStatus::MemoryLimit)
        .value("Interrupted", relax::SearchStatus::Interrupted);

    nb::class_<relax::SearchStatistics>(module, "SearchStatistics")
        .def_ro("expanded", &relax::SearchStatistics::expanded)
        .def_ro("generated", &relax::SearchStatistics::generated)
        .def_ro("evaluated", &relax::SearchStatistics::evaluated)
        .def_ro("dead_ends", &relax::SearchStatistics::dead_ends)
        .def_ro("cuts", &relax::SearchStatistics::cuts)
        .def_ro("lower_bound", &relax::SearchStatistics::lower_bound)
        .def_ro("best", &relax::SearchStatistics::best);

    nb::class_<relax::DecompositionNode>(module, "DecompositionNode")
        .def_ro("task", &relax::DecompositionNode::task)
        .def_ro("method", &relax::DecompositionNode::method)
        .def_ro("parent", &relax::DecompositionNode::parent)
        .def_ro("subtask", &relax::DecompositionNode::subtask);

    nb::class_<relax::SearchResult>(module, "SearchResult")
        .def_ro("status", &relax::SearchResult::status)
        .def_ro("stop", &relax::SearchResult::stop)
        .def_ro("statistics", &relax::SearchResult::statistics)
        .def_ro("cost", &relax::SearchResult::cost)
        .def_prop_ro("node_count", [](const relax::SearchResult& result) { return result.decomposition.size(); })
        .def("node",
             [](const relax::SearchResult& result, std::size_t index) { return result.decomposition.at(index); })
        .def_ro("plan", &relax::SearchResult::plan)
        .def_ro("due_parts", &relax::SearchResult::due_parts)
        .def_ro("due_part_counts", &relax::SearchResult::due_part_counts)
        .def_prop_ro("actions", &executed_actions);

    nb::class_<Evaluator>(module, "Evaluator")
        .def(nb::init<const relax::PricedProblem&, std::string_view>(), "priced"_a, "heuristic"_a,
             nb::keep_alive<1, 2>())
        .def("evaluate", &Evaluator::evaluate, "facts"_a, "tasks"_a, "ordering"_a = nb::none());

    module.def("find_plans", &find_plans, "priced"_a, "options"_a, "seconds"_a = nb::none(),
               "memory_bytes"_a = nb::none(), "steps"_a = nb::none(), "progress"_a = nb::none());
}
