#include "relax/policies/policy_trace.hpp"

#include <algorithm>
#include <limits>

#include "relax/search/plan_trace.hpp"

namespace relax {

namespace {

PolicyEnd end_of(PlanningSource& source, const DecisionGraph& graph, PolicyNodeId node, DecisionId choice) {
    if (source.progression().is_done(source.nodes().network(source.nodes()[node].pair))) {
        return PolicyEnd::Done;
    }
    if (choice != kStop) {
        return PolicyEnd::GoesOn;
    }
    const bool has_none = graph[node].is_expanded && !graph[node].is_done && graph[node].count == 0;
    return has_none ? PolicyEnd::NothingLeft : PolicyEnd::GivesUp;
}

// The method by which nature has chosen an outcome.
MethodId method_of(const GroundProblem& problem, TaskId chance, ActionId outcome) {
    return *std::ranges::find_if(problem.methods_of(chance),
                                 [&](MethodId method) { return problem.outcome_action(method) == outcome; });
}

}  // namespace

PolicyTrace trace_policy(PlanningSource& source, const DecisionGraph& graph, const FoundPolicy& policy,
                         Limits& limits) {
    PolicyTrace trace;
    constexpr std::uint32_t kUnknown = std::numeric_limits<std::uint32_t>::max();
    std::vector<DecisionId> choices(graph.size(), kStop);
    for (std::size_t at = 0; at < policy.nodes.size(); ++at) {
        choices[policy.nodes[at]] = policy.choices[at];
    }
    std::vector<std::uint32_t> index(graph.size(), kUnknown);
    const auto list = [&](PolicyNodeId node) {
        if (index[node] == kUnknown) {
            index[node] = static_cast<std::uint32_t>(trace.nodes.size());
            trace.nodes.push_back(node);
        }
        return index[node];
    };
    list(policy.nodes.front());
    for (std::size_t at = 0; at < trace.nodes.size(); ++at) {
        limits.stop_if_reached();
        const PolicyNodeId node = trace.nodes[at];
        trace.ends.push_back(end_of(source, graph, node, choices[node]));
        trace.first.push_back(static_cast<std::uint32_t>(trace.successors.size()));
        trace.steps.emplace_back();
        if (trace.ends.back() != PolicyEnd::GoesOn) {
            continue;
        }
        const PlanningSource::Traced found = source.trace(node, choices[node] - graph[node].first);
        trace.steps.back() = found.step;
        for (const TracedBranch& branch : found.branches) {
            trace.probabilities.push_back(branch.probability);
            trace.actions.push_back(branch.action);
            trace.due_parts.add_row(branch.due_parts);
            trace.successors.push_back(list(branch.successor));
        }
    }
    trace.first.push_back(static_cast<std::uint32_t>(trace.successors.size()));
    return trace;
}

void trace_run(const PricedProblem& priced, PlanningSource& source, const PolicyTrace& trace,
               std::span<const std::uint32_t> branches, Limits& limits, SearchResult& result) {
    const GroundProblem& problem = priced.problem;
    TaskNetworks& networks = source.progression().networks();
    std::vector<SearchStep> steps;
    std::vector<Origin> origins;
    std::uint32_t node = 0;
    for (const std::uint32_t branch : branches) {
        SearchStep step = trace.steps[node];
        const NetworkId network = source.nodes().network(source.nodes()[trace.nodes[node]].pair);
        const TaskId task = source.progression().ordered_tasks(network).tasks[step.occurrence];
        if (!step.method && !problem.is_primitive(task)) {
            const MethodId method = method_of(problem, task, *trace.actions[branch]);
            networks.decompose(network, step.occurrence, method, &origins);
            steps.push_back({step.occurrence, method});
            step.occurrence =
                static_cast<std::uint32_t>(std::ranges::find_if(origins, &Origin::is_subtask) - origins.begin());
        }
        steps.push_back(step);
        node = trace.successors[branch];
    }
    trace_steps(priced, networks, steps, limits, result);
}

}  // namespace relax
