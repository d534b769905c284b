#ifndef RELAX_HEURISTICS_COMPUTE_RC_AD_HEUR_HPP
#define RELAX_HEURISTICS_COMPUTE_RC_AD_HEUR_HPP

#include <cstddef>
#include <optional>

#include "relax/analysis/relaxed_model.hpp"
#include "relax/heuristics/heuristic.hpp"
#include "relax/heuristics/relaxed_task.hpp"

namespace relax {

// computeRCAdHeur, the paper's Algorithm 5: a classical heuristic on a relaxed model. Where it differs from the paper:
//
// - Lines 2 to 6: the model is built once, with its costs; a node selects the part of it that its network reaches.
//   In the composition model (`composition_model`) methods cost 0 (lines 3 and 4) and actions their risk cost (lines 5
//   and 6), which adds up along a plan; the plain expected utility of the paper does not for exponential utilities.
// - `decomposition_model` is another model to ask a classical heuristic about.
template <typename ClassicalHeuristic>
class RcHeuristic final : public Heuristic {
public:
    RcHeuristic(const RelaxedModel& model, Limits& limits)
        : model_(model), task_(model, ClassicalHeuristic::kReadsOperators, limits), classical_(model, limits) {}

    std::optional<Cost> evaluate(const NodeView& node) override {
        task_.set(node);               // 2
        return classical_.run(task_);  // 7, 8
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
