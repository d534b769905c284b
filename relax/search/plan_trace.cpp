#include "relax/search/plan_trace.hpp"

#include <algorithm>
#include <new>
#include <optional>
#include <vector>

#include "relax/base/cost.hpp"
#include "relax/problem/state.hpp"

namespace relax {

void trace_plan(const PricedProblem& priced, Progression& progression, const SearchSpace& nodes, NodeId goal,
                Limits& limits, SearchResult& result) {
    std::vector<SearchStep> steps;
    for (NodeId id = goal; nodes[id].parent != id; id = nodes[id].parent) {
        steps.push_back(nodes[id].step());
    }
    std::reverse(steps.begin(), steps.end());
    trace_steps(priced, progression.networks(), steps, limits, result);
}

namespace {

// Walk the steps once more and keep track of which task of the decomposition tree each occurrence is. Throws Stopped.
void walk(const PricedProblem& priced, TaskNetworks& networks, std::span<const SearchStep> steps, Limits& limits,
          SearchResult& result) {
    const GroundProblem& problem = priced.problem;
    NetworkId network = networks.initial();
    const StateTransition transition(problem);
    StateBits state = transition.initial_state();
    StateBits next(state.size());
    std::vector<std::uint32_t> tree_node{0};  // by occurrence
    std::vector<std::uint32_t> next_tree_node;
    std::vector<Origin> origins;
    result.decomposition.push_back({problem.initial_task, std::nullopt, std::nullopt, 0});
    result.cost = 0;
    for (const SearchStep& step : steps) {
        limits.stop_if_reached();
        const std::uint32_t here = tree_node[step.occurrence];
        if (step.method) {
            result.decomposition[here].method = step.method;
            network = networks.decompose(network, step.occurrence, *step.method, &origins);
        } else {
            result.plan.push_back(here);
            const ActionId action = problem.action_of(result.decomposition[here].task);
            const std::size_t settled = result.due_parts.size();
            for (const CostPartId part : problem.cost_parts[action]) {
                if (transition.is_due(part, state)) {
                    result.due_parts.push_back(part);
                }
            }
            const auto due_parts = std::span(result.due_parts).subspan(settled);
            result.due_part_counts.push_back(static_cast<std::uint32_t>(due_parts.size()));
            result.cost = add_bounds(*result.cost, priced.cost(action, due_parts));
            transition.apply(action, state, next);
            state.swap(next);
            network = networks.progress(network, step.occurrence, &origins);
        }
        next_tree_node.clear();
        for (const Origin& origin : origins) {
            if (origin.is_subtask) {
                next_tree_node.push_back(static_cast<std::uint32_t>(result.decomposition.size()));
                const TaskId task = problem.method_subtasks[*step.method][origin.index];
                result.decomposition.push_back({task, std::nullopt, here, origin.index});
            } else {
                next_tree_node.push_back(tree_node[origin.index]);
            }
        }
        tree_node.swap(next_tree_node);
    }
}

}  // namespace

void trace_steps(const PricedProblem& priced, TaskNetworks& networks, std::span<const SearchStep> steps, Limits& limits,
                 SearchResult& result) {
    std::optional<StopReason> stop = result.stop;  // of the search, which comes first
    try {
        walk(priced, networks, steps, limits, result);
        return;
    } catch (const Stopped& stopped) {
        stop = stop ? stop : stopped.reason;
    } catch (const std::bad_alloc&) {
        stop = stop ? stop : StopReason::MemoryLimit;
    }
    result = {};
    result.stop = stop;
}

}  // namespace relax
