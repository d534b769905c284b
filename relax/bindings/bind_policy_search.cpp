#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "id_caster.hpp"
#include "node_contents.hpp"
#include "python_limits.hpp"
#include "relax/base/bits.hpp"
#include "relax/policies/cut_source.hpp"
#include "relax/policies/network_source.hpp"
#include "relax/policies/policy_chord.hpp"
#include "relax/policies/policy_trace.hpp"
#include "relax/policies/spending_source.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Amounts = std::vector<double>;
using Seconds = std::optional<double>;
using Bytes = std::optional<std::size_t>;
using Steps = std::optional<std::uint64_t>;

relax::HeuristicInfo admissible(std::string_view name) {
    relax::HeuristicInfo heuristic = relax::heuristic_named(name);
    if (!heuristic.is_admissible) {
        throw std::invalid_argument("the heuristic must be admissible");
    }
    return heuristic;
}

// A policy search on a ground problem: its source, what it has explored, and the policy that it has found last. A run
// may be followed by others from another amount.
class PolicyRun {
public:
    PolicyRun(const relax::PricedProblem& priced, const relax::PolicySearchOptions& options, Amounts probabilities,
              const std::vector<bool>& free_actions, const relax::SeenCosts& seen, bool only_done_runs_pay,
              bool follow_forced, bool forget_unreachable)
        : priced_(priced), options_(options), probabilities_(std::move(probabilities)), follows_forced_(follow_forced) {
        const auto& problem = priced.problem;
        check_entries(problem, free_actions, seen);
        if (probabilities_.size() != problem.action_count()) {
            throw std::invalid_argument("there must be one probability for each action");
        }
        relax::PolicyOptions how{{}, only_done_runs_pay};
        how.forget_unreachable = forget_unreachable;
        progression_.emplace(problem, free_actions, seen, how, limits_);
    }

    void take_amounts(const Amounts& actions, const Amounts& parts, const Amounts& costs, const Amounts& part_costs,
                      double stop, double unit, std::string_view heuristic) {
        make_ = [this, amounts = relax::StepAmounts{actions, parts}, expected = relax::StepAmounts{costs, part_costs},
                 worths = relax::NetworkSource::Worths{options_.recursion, stop, unit},
                 info = admissible(heuristic)]() -> std::unique_ptr<relax::PlanningSource> {
            return std::make_unique<relax::NetworkSource>(*progression_, probabilities_, amounts, expected, worths,
                                                          priced_, info, limits_);
        };
    }

    void take_laws(const relax::CostLaws& laws, const relax::PricedProblem& means, double units_per_step,
                   const Amounts& of_left, double gain, double beyond, double slope, std::optional<double> failure,
                   std::string_view heuristic) {
        using Worths = relax::SpendingSource::Worths;
        using GivingUp = relax::SpendingSource::GivingUp;
        if (of_left.empty()) {
            throw std::invalid_argument("there must be a disutility where nothing is left");
        }
        Worths worths{{of_left, gain, beyond, slope}, GivingUp::No, 0};
        if (failure) {
            worths.giving_up = *failure == relax::kNever ? GivingUp::AsBadAsLate : GivingUp::AtACost;
            worths.failure = *failure;
        }
        make_ = [this, &laws, &means, units_per_step, worths,
                 info = admissible(heuristic)]() -> std::unique_ptr<relax::PlanningSource> {
            auto source = std::make_unique<relax::SpendingSource>(*progression_, probabilities_, laws, worths, priced_,
                                                                  means, units_per_step, info, limits_);
            spending_ = source.get();
            return source;
        };
    }

    void add_term(double slope, double log_weight, const Amounts& actions, const Amounts& parts,
                  const relax::PricedProblem& priced, double unit) {
        terms_.push_back({{slope, log_weight, 1}, {actions, parts}, &priced, unit});
    }

    // `is_only_sought`: as of DisutilityTerm; the recursion of the options must be Seeking then, else LogExpected.
    void take_terms(const relax::CostLaws& laws, double step, double failure, bool is_only_sought,
                    std::string_view heuristic) {
        if (terms_.empty()) {
            throw std::invalid_argument("there must be a term");
        }
        for (auto& [term, amounts, priced, unit] : terms_) {
            term = relax::DisutilityTerm::of(term.slope, term.log_weight, step, is_only_sought);
        }
        make_ = [this, &laws, costs = relax::CutSource::Costs{step, failure},
                 info = admissible(heuristic)]() -> std::unique_ptr<relax::PlanningSource> {
            auto source =
                std::make_unique<relax::CutSource>(*progression_, probabilities_, laws, costs, terms_, info, limits_);
            cut_ = source.get();
            return source;
        };
    }

    void set_precision(double precision) {
        options_.precision = precision;
        if (search_) {
            search_->set_precision(precision);
        }
    }

    double certain_cost(double worth) const {
        std::vector<relax::DisutilityTerm> terms;
        for (const auto& priced : terms_) {
            terms.push_back(priced.term);
        }
        return relax::certain_cost(terms, worth);
    }

    relax::PolicySearchResult run(relax::AmountLeft left, Seconds seconds, Bytes bytes, Steps steps,
                                  const nb::object& progress) {
        if (!make_) {
            throw std::invalid_argument("there must be amounts, or laws");
        }
        std::function<void()> watch;
        if (!progress.is_none()) {
            watch = [&] { progress(statistics_); };
        }
        limits_ = python_limits(seconds, bytes, steps, std::move(watch));
        relax::PolicySearchResult result;
        {
            const nb::gil_scoped_release no_gil;
            result.stop = relax::run_within_limits([&]() -> std::optional<relax::StopReason> {
                if (!source_) {
                    source_ = make_();
                    source_->set_follows_forced(follows_forced_);
                    search_.emplace(*source_, options_, limits_, statistics_);
                }
                return std::nullopt;
            });
            if (search_) {
                if (spending_ != nullptr) {
                    spending_->begin_with(left);
                }
                if (cut_ != nullptr && left >= 0) {
                    cut_->set_cut(left);
                } else if (cut_ != nullptr) {
                    cut_->begin_beyond(static_cast<std::size_t>(-1 - left));
                }
                result = search_->run();
            }
        }
        limits_ = relax::Limits();  // what is asked from now on is worked out whatever they were
        trace_.reset();
        if (result.policy) {
            trace_ = relax::trace_policy(*source_, search_->graph(), *result.policy, limits_);
        }
        return result;
    }

    // Of an averse agent's run. Returns what ended it, and the chord's values at both ends, if there is one.
    std::pair<std::optional<relax::StopReason>, std::optional<std::pair<double, double>>> chord(
        const relax::ChordPrices& prices, Seconds seconds, Bytes bytes, Steps steps) {
        if (options_.recursion != relax::Recursion::Averse || !search_ || search_->graph().size() == 0) {
            throw std::invalid_argument("there must be what an averse agent's search has explored");
        }
        const auto is_inside = [&](double x) { return prices.low <= x && x <= prices.high; };
        if (!(prices.low >= 0 && prices.low < prices.high && prices.high <= prices.explored && prices.touching > 0 &&
              is_inside(prices.touching))) {
            throw std::invalid_argument("the chord's interval is none, or leads beyond what was explored");
        }
        limits_ = python_limits(seconds, bytes, steps);
        std::optional<relax::Chord> found;
        std::optional<relax::StopReason> stop;
        {
            const nb::gil_scoped_release no_gil;
            stop = relax::run_within_limits([&]() -> std::optional<relax::StopReason> {
                found = relax::chord_below(*source_, *search_, prices, limits_);
                return std::nullopt;
            });
        }
        limits_ = relax::Limits();
        return {stop, found ? std::optional(std::pair(found->at_low, found->at_high)) : std::nullopt};
    }

    const relax::PolicyTrace& trace() const {
        if (!trace_) {
            throw std::out_of_range("there is no policy");
        }
        return *trace_;
    }
    // The facts that hold, and those that matter from there on, true or false.
    std::pair<std::vector<relax::FactId>, std::vector<relax::FactId>> facts(std::uint32_t node) {
        const auto pair = place(node).pair;
        const relax::StateId state = source_->nodes().state(pair);
        relax::StateBits known = progression_->facts_that_matter(state, source_->nodes().network(pair));
        relax::StateBits holding = known;
        relax::keep_common(holding, progression_->states()[state]);
        return {facts_in(holding), facts_in(known)};
    }
    std::vector<relax::TaskId> tasks(std::uint32_t node) { return ordered(node).tasks; }
    OrderedPairs ordering(std::uint32_t node) { return ordered_pairs(ordered(node)); }
    // None where it is used up.
    std::optional<relax::AmountLeft> left(std::uint32_t node) {
        const relax::AmountLeft left = place(node).left;
        if (cut_ != nullptr) {
            return cut_->left_of(left);
        }
        return left == relax::kSpent ? std::nullopt : std::optional(left);
    }
    std::pair<std::uint32_t, std::optional<relax::MethodId>> step(std::uint32_t node) const {
        const relax::SearchStep step = trace().steps.at(node);
        return {step.occurrence, step.method};
    }
    std::vector<relax::CostPartId> due_parts(std::uint32_t branch) const {
        if (branch >= trace().successors.size()) {
            throw std::out_of_range("index out of range");
        }
        const auto parts = trace().due_parts[branch];
        return {parts.begin(), parts.end()};
    }
    relax::SearchResult plan(const std::vector<std::uint32_t>& branches) {
        std::uint32_t node = 0;
        for (const std::uint32_t branch : branches) {
            if (branch < trace().first[node] || branch >= trace().first[node + 1]) {
                throw std::out_of_range("a branch must be one of the node that the ones before lead to");
            }
            node = trace().successors[branch];
        }
        relax::SearchResult result;
        relax::trace_run(priced_, *source_, trace(), branches, limits_, result);
        return result;
    }

private:
    const relax::NetworkNodes::Node& place(std::uint32_t node) const { return trace().nodes.at(node); }
    const relax::OrderedTasks& ordered(std::uint32_t node) {
        return progression_->ordered_tasks(source_->nodes().network(place(node).pair));
    }

    const relax::PricedProblem& priced_;
    relax::PolicySearchOptions options_;
    Amounts probabilities_;
    bool follows_forced_;
    relax::Limits limits_;
    relax::PolicyStatistics statistics_;
    std::optional<relax::PolicyProgression> progression_;
    std::function<std::unique_ptr<relax::PlanningSource>()> make_;
    std::unique_ptr<relax::PlanningSource> source_;
    relax::SpendingSource* spending_ = nullptr;
    std::vector<relax::CutSource::PricedTerm> terms_;
    relax::CutSource* cut_ = nullptr;
    std::optional<relax::PolicySearch> search_;
    std::optional<relax::PolicyTrace> trace_;
};

}  // namespace

void bind_policy_search(nb::module_& module) {
    nb::enum_<relax::PolicyEnd>(module, "PolicyEnd")
        .value("GoesOn", relax::PolicyEnd::GoesOn)
        .value("Done", relax::PolicyEnd::Done)
        .value("NothingLeft", relax::PolicyEnd::NothingLeft)
        .value("GivesUp", relax::PolicyEnd::GivesUp);

    nb::class_<PolicyRun>(module, "PolicyRun")
        .def(
            "__init__",
            [](PolicyRun* self, const relax::PricedProblem& priced, const relax::PolicySearchOptions& options,
               Amounts probabilities, const std::vector<bool>& free_actions, std::vector<bool> seen_actions,
               std::vector<bool> seen_parts, bool only_done_runs_pay, bool follow_forced, bool forget_unreachable) {
                new (self) PolicyRun(priced, options, std::move(probabilities), free_actions,
                                     {std::move(seen_actions), std::move(seen_parts)}, only_done_runs_pay,
                                     follow_forced, forget_unreachable);
            },
            "priced"_a, "options"_a, "probabilities"_a, "free_actions"_a, "seen_actions"_a, "seen_parts"_a,
            "only_done_runs_pay"_a, "follow_forced"_a = true, "forget_unreachable"_a = true, nb::keep_alive<1, 2>())
        .def("take_amounts", &PolicyRun::take_amounts, "actions"_a, "parts"_a, "costs"_a, "part_costs"_a, "stop"_a,
             "unit"_a, "heuristic"_a)
        .def("take_laws", &PolicyRun::take_laws, "laws"_a, "means"_a, "units_per_step"_a, "of_left"_a, "gain"_a,
             "beyond"_a, "slope"_a, "failure"_a.none(), "heuristic"_a, nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>())
        .def("add_term", &PolicyRun::add_term, "slope"_a, "log_weight"_a, "actions"_a, "parts"_a, "priced"_a, "unit"_a,
             nb::keep_alive<1, 6>())
        .def("take_terms", &PolicyRun::take_terms, "laws"_a, "step"_a, "failure"_a, "is_only_sought"_a, "heuristic"_a,
             nb::keep_alive<1, 2>())
        .def("set_precision", &PolicyRun::set_precision, "precision"_a)
        .def("certain_cost", &PolicyRun::certain_cost, "worth"_a)
        .def("run", &PolicyRun::run, "left"_a = 0, "seconds"_a = nb::none(), "memory_bytes"_a = nb::none(),
             "steps"_a = nb::none(), "progress"_a = nb::none())
        .def(
            "chord",
            [](PolicyRun& self, const std::pair<Amounts, Amounts>& at_low, const std::pair<Amounts, Amounts>& at_high,
               double low, double high, double touching, double explored, std::pair<double, double> enough,
               Seconds seconds, Bytes bytes, Steps steps) {
                return self.chord({{at_low.first, at_low.second},
                                   {at_high.first, at_high.second},
                                   low,
                                   high,
                                   touching,
                                   explored,
                                   {enough.first, enough.second}},
                                  seconds, bytes, steps);
            },
            "at_low"_a, "at_high"_a, "low"_a, "high"_a, "touching"_a, "explored"_a, "enough"_a,
            "seconds"_a = nb::none(), "memory_bytes"_a = nb::none(), "steps"_a = nb::none())
        .def_prop_ro("ends", [](const PolicyRun& self) { return self.trace().ends; })
        .def_prop_ro("first", [](const PolicyRun& self) { return self.trace().first; })
        .def_prop_ro("probabilities", [](const PolicyRun& self) { return self.trace().probabilities; })
        .def_prop_ro("actions", [](const PolicyRun& self) { return self.trace().actions; })
        .def_prop_ro("successors", [](const PolicyRun& self) { return self.trace().successors; })
        .def("due_parts", &PolicyRun::due_parts, "branch"_a)
        .def("step", &PolicyRun::step, "node"_a)
        .def("facts", &PolicyRun::facts, "node"_a)
        .def("tasks", &PolicyRun::tasks, "node"_a)
        .def("ordering", &PolicyRun::ordering, "node"_a)
        .def("left", &PolicyRun::left, "node"_a)
        .def("plan", &PolicyRun::plan, "branches"_a);
}
