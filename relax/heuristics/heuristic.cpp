#include "relax/heuristics/heuristic.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "relax/base/cost.hpp"
#include "relax/heuristics/compute_rc_ad_heur.hpp"
#include "relax/heuristics/hmax.hpp"
#include "relax/heuristics/lm_cut.hpp"
#include "relax/heuristics/relaxed_plan.hpp"

namespace relax {

namespace {

class Blind final : public Heuristic {
public:
    std::optional<Cost> evaluate(const NodeView& /*node*/) override { return 0; }
};

class TdgBound final : public Heuristic {
public:
    std::optional<Cost> evaluate(const NodeView& node) override {
        return node.tdg_bound >= kInfinity ? std::nullopt : std::optional(node.tdg_bound);
    }
};

// The max heuristic with the costs of the model, as LM-cut has it with costs that it lowers.
class PricedHMax {
public:
    static constexpr bool kReadsOperators = true;

    PricedHMax(const RelaxedModel& model, Limits& limits) : model_(model), hmax_(model, limits) {}
    std::optional<Cost> run(const RelaxedTask& task) { return hmax_.run(task, model_.owner_cost); }
    std::uint64_t work() const { return hmax_.work(); }

private:
    const RelaxedModel& model_;
    HMax hmax_;
};

// The network's bound, and a heuristic for what a plan costs beyond it, in the decomposition model.
template <typename ClassicalHeuristic>
class Slack final : public Heuristic {
public:
    Slack(const RelaxedModel& model, Limits& limits) : slack_(model, limits) {}

    std::optional<Cost> evaluate(const NodeView& node) override {
        const auto slack = slack_.evaluate(node);
        return slack && node.tdg_bound < kInfinity ? std::optional(add_bounds(node.tdg_bound, *slack)) : std::nullopt;
    }

    std::uint64_t work() const override { return slack_.work(); }
    std::uint64_t rounds() const override { return slack_.rounds(); }

private:
    RcHeuristic<ClassicalHeuristic> slack_;
};

class Additive : private RelaxedPlan {
public:
    using RelaxedPlan::kReadsOperators;
    using RelaxedPlan::work;

    Additive(const RelaxedModel& model, Limits& limits) : RelaxedPlan(model, limits) {}
    std::optional<Cost> run(const RelaxedTask& task) { return add(task); }
};

class Ff : private RelaxedPlan {
public:
    using RelaxedPlan::kReadsOperators;
    using RelaxedPlan::uses;
    using RelaxedPlan::work;

    Ff(const RelaxedModel& model, Limits& limits) : RelaxedPlan(model, limits) {}
    std::optional<Cost> run(const RelaxedTask& task) { return ff(task); }
};

template <typename Alone>
std::unique_ptr<Heuristic> make_alone(const PricedProblem& /*priced*/, Limits& /*limits*/) {
    return std::make_unique<Alone>();
}

template <typename ClassicalHeuristic>
std::unique_ptr<Heuristic> make_on_composition(const PricedProblem& priced, Limits& limits) {
    return std::make_unique<RcHeuristic<ClassicalHeuristic>>(priced.composition_model(limits), limits);
}

template <typename ClassicalHeuristic>
std::unique_ptr<Heuristic> make_on_decomposition(const PricedProblem& priced, Limits& limits) {
    return std::make_unique<Slack<ClassicalHeuristic>>(priced.decomposition_model(limits), limits);
}

// A new heuristic is a line here, and a pair of files that has it.
constexpr std::array kHeuristics = {
    HeuristicInfo{.name = "blind",
                  .description = "always 0: uniform-cost search",
                  .is_blind = true,
                  .has_model = false,
                  .make = make_alone<Blind>},
    HeuristicInfo{.name = "tdg",
                  .description = "least cost of any decomposition, states ignored (the paper's Algorithms 1 and 2)",
                  .has_model = false,
                  .make = make_alone<TdgBound>},
    HeuristicInfo{.name = "hmax",
                  .description = "max heuristic on the relaxed model (the paper's Algorithm 5; Bonet and Geffner 2001)",
                  .make = make_on_composition<PricedHMax>},
    HeuristicInfo{
        .name = "lmcut",
        .description = "landmark cuts on the relaxed model (the paper's Algorithm 5; Helmert and Domshlak 2009)",
        .is_consistent = false,
        .make = make_on_composition<LmCut>},
    HeuristicInfo{.name = "potential",
                  .description = "decomposition-graph bound, plus landmark cuts on what methods cost beyond it, in the "
                                 "hierarchy's order",
                  .is_consistent = false,
                  .make = make_on_decomposition<LmCut>},
    HeuristicInfo{.name = "potential-hmax",
                  .description =
                      "the same with the max heuristic instead of landmark cuts: a little less, in a fraction of the "
                      "time",
                  .is_consistent = false,
                  .make = make_on_decomposition<PricedHMax>},
    HeuristicInfo{.name = "add",
                  .description = "additive heuristic on the relaxed model, for greedy search (Bonet and Geffner 2001)",
                  .is_admissible = false,
                  .is_consistent = false,
                  .make = make_on_composition<Additive>},
    HeuristicInfo{.name = "ff",
                  .description = "relaxed plan on the relaxed model, for greedy search (Hoffmann and Nebel 2001)",
                  .is_admissible = false,
                  .is_consistent = false,
                  .make = make_on_composition<Ff>},
};

}  // namespace

std::span<const HeuristicInfo> heuristics() { return kHeuristics; }

const HeuristicInfo& heuristic_named(std::string_view name) {
    const auto* const found = std::ranges::find(kHeuristics, name, &HeuristicInfo::name);
    if (found == kHeuristics.end()) {
        throw std::invalid_argument("no such heuristic: " + std::string(name));
    }
    return *found;
}

}  // namespace relax
