#include "relax/heuristics/heuristic.hpp"

#include <vector>

#include "relax/analysis/cost_shifting.hpp"
#include "relax/analysis/tdg_bound.hpp"
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

// A heuristic for what a plan costs beyond the network's bounds, in the decomposition model. Every method costs its
// slack, the sum of its subtasks' bounds less its task's, and of an action only the cost parts cost something: a plan
// costs the sum of the network's bounds, of the slacks of the methods it uses and of the cost parts that are due.
template <typename ClassicalHeuristic>
class Slack final : public Heuristic {
public:
    Slack(const GroundProblem& problem, const Prices& prices, Limits& limits)
        : slack_(RelaxedModel::decomposition(problem, slacks(problem, tdg_bound(problem, prices.actions, limits)),
                                             prices.parts, limits),
                 limits) {}

    std::optional<Cost> evaluate(const NodeView& node) override {
        const auto slack = slack_.evaluate(node);
        return slack && node.tdg_bound < kInfinity ? std::optional(add_bounds(node.tdg_bound, *slack)) : std::nullopt;
    }

    std::uint64_t work() const override { return slack_.work(); }
    std::uint64_t rounds() const override { return slack_.rounds(); }
    std::size_t model_bytes() const override { return slack_.model_bytes(); }

private:
    static std::vector<Cost> slacks(const GroundProblem& problem, const std::vector<Cost>& bounds) {
        std::vector<Cost> slacks;
        for (const MethodId method : problem.methods()) {
            Cost sum = 0;
            for (const TaskId subtask : problem.method_subtasks[method]) {
                sum = add_bounds(sum, bounds[subtask]);
            }
            slacks.push_back(sum - bounds[problem.method_task[method]]);
        }
        return slacks;
    }

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

}  // namespace

std::unique_ptr<Heuristic> make_heuristic(HeuristicKind kind, const GroundProblem& problem, const Prices& true_prices,
                                          Limits& limits) {
    const Prices prices = shift_costs(problem, true_prices, limits);
    switch (kind) {
        case HeuristicKind::Blind:
            return std::make_unique<Blind>();
        case HeuristicKind::Tdg:
            return std::make_unique<TdgBound>();
        case HeuristicKind::HMax:
            return std::make_unique<RcHeuristic<PricedHMax>>(RelaxedModel::composition(problem, prices, limits),
                                                             limits);
        case HeuristicKind::LmCut:
            return std::make_unique<RcHeuristic<LmCut>>(RelaxedModel::composition(problem, prices, limits), limits);
        case HeuristicKind::Potential:
            return std::make_unique<Slack<LmCut>>(problem, prices, limits);
        case HeuristicKind::PotentialHMax:
            return std::make_unique<Slack<PricedHMax>>(problem, prices, limits);
        case HeuristicKind::Add:
            return std::make_unique<RcHeuristic<Additive>>(RelaxedModel::composition(problem, prices, limits), limits);
        case HeuristicKind::Ff:
            return std::make_unique<RcHeuristic<Ff>>(RelaxedModel::composition(problem, prices, limits), limits);
    }
    return nullptr;
}

}  // namespace relax
