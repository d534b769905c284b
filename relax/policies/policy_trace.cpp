#include "relax/policies/policy_trace.hpp"

#include <algorithm>
#include <map>
#include <utility>

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

// Writes a policy down, as far as runs come: each of its nodes, followed by what its decision goes through for certain.
class Tracer {
public:
    Tracer(PlanningSource& source, const DecisionGraph& graph, const FoundPolicy& policy)
        : source_(source),
          graph_(graph),
          policy_(policy),
          choices_(graph.size(), kStop),
          is_reached_(graph.size()),
          numbers_(graph.size()) {
        for (std::size_t at = 0; at < policy.nodes.size(); ++at) {
            choices_[policy.nodes[at]] = policy.choices[at];
        }
    }

    PolicyTrace trace(Limits& limits) {
        reach(policy_.nodes.front());
        for (std::size_t at = 0; at < reached_.size(); ++at) {
            limits.stop_if_reached();
            const PolicyNodeId node = reached_[at];
            numbers_[node] = static_cast<std::uint32_t>(trace_.nodes.size());
            add(source_.nodes()[node], end_of(source_, graph_, node, choices_[node]));
            if (trace_.ends.back() == PolicyEnd::GoesOn) {
                add_steps(node);
            }
        }
        trace_.first.push_back(static_cast<std::uint32_t>(trace_.successors.size()));
        for (const auto& [branch, node] : links_) {
            trace_.successors[branch] = numbers_[node];
        }
        return std::move(trace_);
    }

private:
    void add(const NetworkNodes::Node& node, PolicyEnd end) {
        trace_.nodes.push_back(node);
        trace_.ends.push_back(end);
        trace_.steps.emplace_back();
        trace_.first.push_back(static_cast<std::uint32_t>(trace_.successors.size()));
    }

    void add_steps(PolicyNodeId node) {
        const AmountLeft left = source_.nodes()[node].left;
        const auto [steps, branches] = source_.trace(node, choices_[node] - graph_[node].first);
        trace_.steps.back() = steps.front().step;
        for (const TracedStep& step : steps.subspan(1)) {
            const NetworkNodes::Node to{source_.pair_of(step.state, step.network), left};
            if (is_known(to, step.before)) {
                return;
            }
            passed_.emplace(key_of(to), static_cast<std::uint32_t>(trace_.nodes.size()));
            add_branch(1, step.before, {}, static_cast<std::uint32_t>(trace_.nodes.size()));
            add(to, PolicyEnd::GoesOn);
            trace_.steps.back() = step.step;
        }
        for (const TracedBranch& branch : branches) {
            add_link(branch.probability, branch.action, branch.due_parts, branch.successor);
        }
    }

    // Whether the policy has this state and network anyway; what goes on there was written or will be.
    bool is_known(const NetworkNodes::Node& to, std::optional<ActionId> action) {
        const PolicyNodeId node = source_.nodes().find(to.pair, to.left);
        if (node < choices_.size() && choices_[node] != kStop) {
            add_link(1, action, {}, node);
            return true;
        }
        const auto found = passed_.find(key_of(to));
        if (found != passed_.end()) {
            add_branch(1, action, {}, found->second);
        }
        return found != passed_.end();
    }

    void reach(PolicyNodeId node) {
        if (!is_reached_[node]) {
            is_reached_[node] = true;
            reached_.push_back(node);
        }
    }

    // A branch to a node of the graph, whose number may not be known yet.
    void add_link(double probability, std::optional<ActionId> action, std::span<const CostPartId> due_parts,
                  PolicyNodeId node) {
        reach(node);
        links_.emplace_back(trace_.successors.size(), node);
        add_branch(probability, action, due_parts, 0);
    }

    void add_branch(double probability, std::optional<ActionId> action, std::span<const CostPartId> due_parts,
                    std::uint32_t successor) {
        trace_.probabilities.push_back(probability);
        trace_.actions.push_back(action);
        trace_.due_parts.add_row(due_parts);
        trace_.successors.push_back(successor);
    }

    static std::pair<PairId, AmountLeft> key_of(const NetworkNodes::Node& node) { return {node.pair, node.left}; }

    PlanningSource& source_;
    const DecisionGraph& graph_;
    const FoundPolicy& policy_;
    PolicyTrace trace_;
    std::vector<DecisionId> choices_;     // by node of the graph; kStop where it is none of the policy
    std::vector<PolicyNodeId> reached_;   // nodes of the graph to which runs come, each to be written
    std::vector<bool> is_reached_;        // by node of the graph
    std::vector<std::uint32_t> numbers_;  // by node of the graph, in the trace
    std::vector<std::pair<std::size_t, PolicyNodeId>> links_;  // branches whose successors are not written yet
    std::map<std::pair<PairId, AmountLeft>, std::uint32_t> passed_;
};

// The method by which nature has chosen an outcome.
MethodId method_of(const GroundProblem& problem, TaskId chance, ActionId outcome) {
    return *std::ranges::find_if(problem.methods_of(chance),
                                 [&](MethodId method) { return problem.outcome_action(method) == outcome; });
}

}  // namespace

PolicyTrace trace_policy(PlanningSource& source, const DecisionGraph& graph, const FoundPolicy& policy,
                         Limits& limits) {
    return Tracer(source, graph, policy).trace(limits);
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
        const NetworkId network = source.nodes().network(trace.nodes[node].pair);
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
