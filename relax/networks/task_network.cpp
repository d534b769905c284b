#include "relax/networks/task_network.hpp"

#include "relax/networks/partially_ordered_networks.hpp"
#include "relax/networks/totally_ordered_networks.hpp"

namespace relax {

std::unique_ptr<TaskNetworks> make_task_networks(const AnalysedProblem& problem, bool use_macros, bool in_sequence,
                                                 Limits& limits) {
    if (in_sequence || TotallyOrderedNetworks::fits(problem)) {
        return std::make_unique<TotallyOrderedNetworks>(problem, use_macros, limits);
    }
    return std::make_unique<PartiallyOrderedNetworks>(problem, limits);
}

}  // namespace relax
