#ifndef RELAX_HEURISTICS_COMPUTE_RC_AD_HEUR_HPP
#define RELAX_HEURISTICS_COMPUTE_RC_AD_HEUR_HPP

#include <cstddef>
#include <optional>

#include "relax/analysis/relaxed_model.hpp"
#include "relax/heuristics/heuristic.hpp"
#include "relax/heuristics/relaxed_task.hpp"

namespace relax {

// computeRCAdHeur (the paper's Algorithm 5): a classical heuristic on a relaxed model. In the composition model methods
// are free and actions cost what they are worth to the agent. The model is built once; a node only selects its part of
// it.
template <typename ClassicalHeuristic>
class RcHeuristic final : public Heuristic {
public:
    RcHeuristic(const RelaxedModel& model, Limits& limits)
        : model_(model), task_(model, ClassicalHeuristic::kReadsOperators, limits), classical_(model, limits) {}

    std::optional<Cost> evaluate(const NodeView& node) override {
        task_.set(node);
        return classical_.run(task_);
    }

    std::uint64_t work() const override {
        if constexpr (requires { classical_.work(); }) {
            return classical_.work();
        }
        return 0;
    }

    std::uint64_t rounds() const override {
        if constexpr (requires { classical_.rounds(); }) {
            return classical_.rounds();
        }
        return 0;
    }

    std::size_t model_bytes() const override { return model_.bytes(); }

    bool is_preferred(MethodId method) const override {
        if constexpr (requires { classical_.uses(OperatorId{}); }) {
            return classical_.uses(model_.method_operator[method]);
        }
        return false;
    }

private:
    const RelaxedModel& model_;
    RelaxedTask task_;
    ClassicalHeuristic classical_;
};

}  // namespace relax

#endif
