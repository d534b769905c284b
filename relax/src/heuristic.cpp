#include "relax/heuristic.hpp"

#include "relax/hmax.hpp"
#include "relax/lm_cut.hpp"
#include "relax/rc_heuristic.hpp"
#include "relax/relaxed_plan.hpp"
#include "relax/tdg_bound.hpp"

namespace relax {

namespace {

class Blind final : public Heuristic {
public:
    std::optional<Cost> evaluate(const NodeView& /*node*/) override { return 0; }
};

class TdgBound final : public Heuristic {
public:
    std::optional<Cost> evaluate(const NodeView& node) override {
        return node.tdg_bound >= kNoDecomposition ? std::nullopt : std::optional(node.tdg_bound);
    }
};

// The max heuristic with the costs of the model, as LM-cut has it with costs that it lowers.
class PricedHMax {
public:
    explicit PricedHMax(const RelaxedModel& model) : model_(model), hmax_(model) {}
    std::optional<Cost> run(const RelaxedTask& task) { return hmax_.run(task, model_.owner_cost); }

private:
    const RelaxedModel& model_;
    HMax hmax_;
};

class Additive : private RelaxedPlan {
public:
    using RelaxedPlan::RelaxedPlan;
    std::optional<Cost> run(const RelaxedTask& task) { return add(task); }
};

class Ff : private RelaxedPlan {
public:
    using RelaxedPlan::RelaxedPlan;
    std::optional<Cost> run(const RelaxedTask& task) { return ff(task); }
};

}  // namespace

std::unique_ptr<Heuristic> make_heuristic(HeuristicKind kind, const GroundProblem& problem, std::span<const Cost> costs) {
    switch (kind) {
        case HeuristicKind::Blind:
            return std::make_unique<Blind>();
        case HeuristicKind::Tdg:
            return std::make_unique<TdgBound>();
        case HeuristicKind::HMax:
            return std::make_unique<RcHeuristic<PricedHMax>>(problem, costs);
        case HeuristicKind::LmCut:
            return std::make_unique<RcHeuristic<LmCut>>(problem, costs);
        case HeuristicKind::Add:
            return std::make_unique<RcHeuristic<Additive>>(problem, costs);
        case HeuristicKind::Ff:
            return std::make_unique<RcHeuristic<Ff>>(problem, costs);
    }
    return nullptr;
}

}  // namespace relax
