#include "relax/progression.hpp"

#include <utility>

namespace relax {

Progression::Progression(const GroundProblem& problem, std::vector<Cost> costs, std::vector<Cost> task_bounds)
    : problem_(problem),
      costs_(std::move(costs)),
      transition_(problem),
      states_(transition_.word_count()),
      networks_(make_task_networks(problem, std::move(task_bounds))),
      next_(transition_.word_count()) {}

StateId Progression::initial_state() { return states_.intern(transition_.initial_state()); }

void Progression::expand(StateId state, NetworkId network, std::vector<Successor>& successors) {
    successors.clear();
    unconstrained_.clear();
    networks_->unconstrained(network, unconstrained_);
    if (const auto compound = compound_to_decompose()) {
        for (const MethodId method : problem_.methods_of(compound->task)) {
            const NetworkId next = networks_->decompose(network, compound->index, method);
            successors.push_back({state, next, 0, {compound->index, method}});
        }
        return;
    }
    for (const Occurrence& occurrence : unconstrained_) {
        if (!transition_.is_applicable(occurrence.task, states_[state])) {
            continue;
        }
        if (costs_[occurrence.task] == 0 && transition_.has_no_effect(occurrence.task)) {
            successors.assign(1, execute(state, network, occurrence));
            return;
        }
        successors.push_back(execute(state, network, occurrence));
    }
}

// The unconstrained compound task with the fewest methods, the first one among equals.
std::optional<Occurrence> Progression::compound_to_decompose() const {
    std::optional<Occurrence> best;
    std::size_t fewest = 0;
    for (const Occurrence& occurrence : unconstrained_) {
        if (!problem_.is_primitive(occurrence.task)) {
            const std::size_t count = problem_.methods_of(occurrence.task).size();
            if (!best || count < fewest) {
                best = occurrence;
                fewest = count;
            }
        }
    }
    return best;
}

Successor Progression::execute(StateId state, NetworkId network, const Occurrence& occurrence) {
    transition_.apply(occurrence.task, states_[state], next_);
    return {states_.intern(next_),
            networks_->progress(network, occurrence.index),
            costs_[occurrence.task],
            {occurrence.index, std::nullopt}};
}

}  // namespace relax
