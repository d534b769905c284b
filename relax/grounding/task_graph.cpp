#include "task_graph.hpp"

#include <algorithm>

#include "method_rule.hpp"

namespace relax::grounding {

namespace {

class MethodExpander {
public:
    MethodExpander(Knowledge& knowledge, const Demand& demand, Limits& limits)
        : knowledge_(knowledge),
          demand_(demand),
          limits_(limits),
          joiner_(knowledge, limits, [this](std::uint32_t method, Bindings& bindings) { add(method, bindings); }) {
        NodeId nodes = 0;
        for (std::uint32_t task = 0; task < knowledge.task_count(); ++task) {
            knowledge.relations[knowledge.task_relation(task)].show_all(limits);
            graph_.task_begin.push_back(nodes);
            nodes += knowledge.relations[knowledge.task_relation(task)].size();
        }
        graph_.task_begin.push_back(nodes);
        graph_.action_node_count = graph_.task_begin[knowledge.problem.actions.size()];
        graph_.initial = graph_.task_begin[knowledge.problem.initial_task];
        graph_.is_node_alive.assign(nodes, false);
        graph_.methods_of.assign(nodes - graph_.action_node_count, {0, 0});
        plan();
    }

    TaskGraph expand() {
        need(graph_.initial, knowledge_.problem.initial_task);
        while (!pending_.empty()) {
            const auto [node, task] = pending_.back();
            pending_.pop_back();
            const auto first = static_cast<MethodInstanceId>(graph_.method_task.size());
            for (const std::uint32_t method : methods_of_task_[task - knowledge_.problem.actions.size()]) {
                limits_.stop_if_reached();
                task_node_ = node;
                joiner_.run(rules_[method], plans_[method], node - graph_.task_begin[task]);
            }
            graph_.methods_of[node - graph_.action_node_count] = {
                first, static_cast<MethodInstanceId>(graph_.method_task.size())};
        }
        graph_.is_method_alive.assign(graph_.method_task.size(), true);
        return std::move(graph_);
    }

private:
    // A method's rule begins with its task's instance, which is given.
    void plan() {
        const LiftedProblem& problem = knowledge_.problem;
        const std::vector<bool> nothing_grows(knowledge_.relations.size(), false);
        methods_of_task_.resize(problem.tasks.size());
        rules_.resize(problem.methods.size());
        plans_.resize(problem.methods.size());
        for (std::uint32_t number = 0; number < problem.methods.size(); ++number) {
            const LiftedMethod& method = problem.methods[number];
            if (demand_.is_method_demanded[number]) {
                Rule& rule = rules_[number] = method_rule(knowledge_, demand_, number);
                rule.patterns.insert(rule.patterns.begin(),
                                     {knowledge_.task_relation(method.task), method.task_arguments});
                plans_[number] = plan_join(knowledge_, nothing_grows, rule, number, 0, limits_);
                methods_of_task_[method.task - problem.actions.size()].push_back(number);
                mark_free_slots(number);
            }
        }
    }

    // Slots that the rule leaves open may be anything: they get their first
    // object.
    void mark_free_slots(std::uint32_t number) {
        const LiftedMethod& method = knowledge_.problem.methods[number];
        std::vector<bool> is_bound(method.slot_count, false);
        for (const Pattern& pattern : rules_[number].patterns) {
            for (const Term term : pattern.terms) {
                if (term >= 0) {
                    is_bound[static_cast<std::size_t>(term)] = true;
                }
            }
        }
        for (const std::uint32_t slot : rules_[number].head) {
            is_bound[slot] = true;
        }
        free_slots_.resize(knowledge_.problem.methods.size());
        for (std::uint32_t slot = 0; slot < method.parameters.size(); ++slot) {
            if (!is_bound[slot]) {
                free_slots_[number].push_back(slot);
            }
        }
    }

    void add(std::uint32_t number, Bindings& bindings) {
        const LiftedMethod& method = knowledge_.problem.methods[number];
        for (const std::uint32_t slot : free_slots_[number]) {
            bindings[slot] = demand_.method_slots[number][slot].members().front();
        }
        graph_.method_schema.push_back(number);
        graph_.method_task.push_back(task_node_);
        graph_.method_arguments.add_row(std::span(bindings).first(method.parameters.size()));
        for (const LiftedSubtask& subtask : method.subtasks) {
            arguments_.clear();
            for (const Term term : subtask.arguments) {
                arguments_.push_back(object_of(term, bindings));
            }
            const TupleId instance = *knowledge_.relations[knowledge_.task_relation(subtask.task)].find(arguments_);
            const NodeId node = graph_.task_begin[subtask.task] + instance;
            graph_.method_subtasks.push(node);
            need(node, subtask.task);
        }
        graph_.method_subtasks.finish_row();
    }

    void need(NodeId node, std::uint32_t task) {
        if (!graph_.is_node_alive[node]) {
            graph_.is_node_alive[node] = true;
            if (!knowledge_.is_action(task)) {
                pending_.emplace_back(node, task);
            }
        }
    }

    Knowledge& knowledge_;
    const Demand& demand_;
    Limits& limits_;
    Joiner joiner_;
    std::vector<std::vector<std::uint32_t>> methods_of_task_;  // by compound task
    std::vector<Rule> rules_;                                  // by method
    std::vector<JoinPlan> plans_;
    std::vector<std::vector<std::uint32_t>> free_slots_;
    TaskGraph graph_;
    NodeId task_node_ = 0;
    std::vector<std::pair<NodeId, std::uint32_t>> pending_;
    std::vector<ObjectId> arguments_;
};

}  // namespace

TaskGraph expand_methods(Knowledge& knowledge, const Demand& demand, Limits& limits) {
    return MethodExpander(knowledge, demand, limits).expand();
}

void prune_bottom_up(TaskGraph& graph, Limits& limits) {
    const std::size_t nodes = graph.is_node_alive.size();
    const auto users = invert(graph.method_subtasks, nodes, limits,
                              [&](MethodInstanceId method) { return bool{graph.is_method_alive[method]}; });
    std::vector<std::size_t> missing(graph.method_task.size(), 0);
    std::vector<bool> is_reached(nodes, false);
    std::vector<NodeId> pending;
    const auto reach = [&](NodeId node) {
        if (!is_reached[node] && graph.is_node_alive[node]) {
            is_reached[node] = true;
            pending.push_back(node);
        }
    };
    for (MethodInstanceId method = 0; method < graph.method_task.size(); ++method) {
        if (graph.is_method_alive[method]) {
            limits.stop_if_reached();
            missing[method] = graph.method_subtasks[method].size();
            if (missing[method] == 0) {
                reach(graph.method_task[method]);
            }
        }
    }
    for (NodeId action = 0; action < graph.action_node_count; ++action) {
        reach(action);
    }
    while (!pending.empty()) {
        limits.stop_if_reached();
        const NodeId node = pending.back();
        pending.pop_back();
        for (const MethodInstanceId method : users[node]) {
            if (--missing[method] == 0) {
                reach(graph.method_task[method]);
            }
        }
    }
    for (MethodInstanceId method = 0; method < graph.method_task.size(); ++method) {
        graph.is_method_alive[method] =
            graph.is_method_alive[method] && missing[method] == 0 && is_reached[graph.method_task[method]];
    }
    graph.is_node_alive = std::move(is_reached);
}

void prune_top_down(TaskGraph& graph, Limits& limits) {
    std::vector<bool> is_reached(graph.is_node_alive.size(), false);
    std::vector<NodeId> pending;
    const auto reach = [&](NodeId node) {
        if (!is_reached[node] && graph.is_node_alive[node]) {
            is_reached[node] = true;
            pending.push_back(node);
        }
    };
    reach(graph.initial);
    while (!pending.empty()) {
        limits.stop_if_reached();
        const NodeId node = pending.back();
        pending.pop_back();
        if (node < graph.action_node_count) {
            continue;
        }
        const auto [first, end] = graph.methods_of[node - graph.action_node_count];
        for (MethodInstanceId method = first; method < end; ++method) {
            if (graph.is_method_alive[method]) {
                std::ranges::for_each(graph.method_subtasks[method], reach);
            }
        }
    }
    for (MethodInstanceId method = 0; method < graph.method_task.size(); ++method) {
        graph.is_method_alive[method] = graph.is_method_alive[method] && is_reached[graph.method_task[method]];
    }
    graph.is_node_alive = std::move(is_reached);
}

}  // namespace relax::grounding
