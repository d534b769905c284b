#ifndef RELAX_RC_HEURISTIC_HPP
#define RELAX_RC_HEURISTIC_HPP

#include "relax/heuristic.hpp"
#include "relax/relaxed_model.hpp"

namespace relax {

// computeRCAdHeur (the paper's Algorithm 5): a classical heuristic on the relaxed model, in which methods are free
// and actions cost what they are worth to the agent. The model is built once; a node only selects its part of it.
template <typename ClassicalHeuristic>
class RcHeuristic final : public Heuristic {
public:
    RcHeuristic(const GroundProblem& problem, std::span<const Cost> costs, Limits& limits,
                std::span<const Cost> method_costs = {})
        : model_(problem, costs, method_costs),
          task_(model_, ClassicalHeuristic::kReadsOperators),
          classical_(model_, limits) {}

    std::optional<Cost> evaluate(const NodeView& node) override {
        task_.set(node.state, node.tasks);
        return classical_.run(task_);
    }

    std::uint64_t work() const override {
        if constexpr (requires { classical_.work(); }) {
            return classical_.work();
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
    RelaxedModel model_;
    RelaxedTask task_;
    ClassicalHeuristic classical_;
};

}  // namespace relax

#endif
