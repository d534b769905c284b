#include "relax/heuristics/heuristic.hpp"

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
    std::size_t model_bytes() const override { return slack_.model_bytes(); }

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

}  // namespace

std::unique_ptr<Heuristic> make_heuristic(HeuristicKind kind, const PricedProblem& priced, Limits& limits) {
    switch (kind) {
        case HeuristicKind::Blind:
            return std::make_unique<Blind>();
        case HeuristicKind::Tdg:
            return std::make_unique<TdgBound>();
        case HeuristicKind::HMax:
            return std::make_unique<RcHeuristic<PricedHMax>>(priced.composition_model(limits), limits);
        case HeuristicKind::LmCut:
            return std::make_unique<RcHeuristic<LmCut>>(priced.composition_model(limits), limits);
        case HeuristicKind::Potential:
            return std::make_unique<Slack<LmCut>>(priced.decomposition_model(limits), limits);
        case HeuristicKind::PotentialHMax:
            return std::make_unique<Slack<PricedHMax>>(priced.decomposition_model(limits), limits);
        case HeuristicKind::Add:
            return std::make_unique<RcHeuristic<Additive>>(priced.composition_model(limits), limits);
        case HeuristicKind::Ff:
            return std::make_unique<RcHeuristic<Ff>>(priced.composition_model(limits), limits);
    }
    return nullptr;
}

}  // namespace relax
