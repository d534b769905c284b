#include "relax/grounder.hpp"

#include <new>
#include <utility>
#include <vector>

#include "cases.hpp"
#include "emission.hpp"
#include "pruning.hpp"
#include "reachability.hpp"

namespace relax {

std::variant<GroundProblem, StopReason, TooManyCasesOf> ground(const LiftedProblem& problem, Limits& limits) {
    try {
        Reachability reachability(problem, limits);
        reachability.run();
        CaseBuilder builder(reachability);
        std::vector<ActionCase> cases;
        try {
            for (const TaskInstance& instance : reachability.needed()) {
                reachability.check_limits();
                if (instance.task < problem.actions.size()) {
                    builder.build(instance, cases);
                }
            }
        } catch (const TooManyCases& error) {
            const auto arguments = reachability.instances(error.instance.task)[error.instance.tuple];
            return TooManyCasesOf{error.instance.task, {arguments.begin(), arguments.end()}};
        }
        const Pruned pruned = prune(reachability, builder, cases);
        return emit(reachability, builder, std::move(cases), pruned);
    } catch (const GroundingStopped& stopped) {
        return stopped.reason;
    } catch (const std::bad_alloc&) {
        return StopReason::MemoryLimit;
    }
}

}  // namespace relax
