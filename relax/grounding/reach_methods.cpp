#include <algorithm>
#include <set>
#include <utility>

#include "formulas.hpp"
#include "join.hpp"
#include "method_rule.hpp"
#include "reachability.hpp"

namespace relax::grounding {

Rule method_rule(const Knowledge& knowledge, const Demand& demand, std::uint32_t number) {
    const LiftedMethod& method = knowledge.problem.methods[number];
    Rule rule;
    rule.slot_count = method.slot_count;
    rule.domains.assign(method.slot_count, nullptr);
    for (std::uint32_t slot = 0; slot < method.parameters.size(); ++slot) {
        rule.domains[slot] = &demand.method_slots[number][slot];
    }
    // A subtask that occurs several times with the same arguments needs to be reached once only.
    std::set<std::pair<std::uint32_t, std::vector<Term>>> seen;
    for (const LiftedSubtask& subtask : method.subtasks) {
        if (seen.emplace(subtask.task, subtask.arguments).second) {
            rule.patterns.push_back({knowledge.task_relation(subtask.task), subtask.arguments});
        }
    }
    for (const PairRelation& pairs : demand.pair_relations[method.task]) {
        rule.patterns.push_back(
            {pairs.relation, {method.task_arguments[pairs.first], method.task_arguments[pairs.second]}});
    }
    std::vector<Formula> constraints;
    split_conjunction(normal_form(knowledge, method.constraints), constraints);
    for (Formula& constraint : constraints) {
        if (constraint.kind == FormulaKind::Atom) {
            rule.patterns.push_back({constraint.symbol, std::move(constraint.terms)});
        } else {
            rule.tests.push_back(std::move(constraint));
        }
    }
    // Parameters that neither the task nor a constraint mentions are bound by the
    // subtasks, or do not matter.
    for (const Formula& test : rule.tests) {
        free_slots(test, rule.head);
    }
    for (const Term term : method.task_arguments) {
        if (term >= 0) {
            rule.head.push_back(static_cast<std::uint32_t>(term));
        }
    }
    std::ranges::sort(rule.head);
    const auto repeated = std::ranges::unique(rule.head);
    rule.head.erase(repeated.begin(), repeated.end());
    return rule;
}

namespace {

Rule accomplishing_rule(const Knowledge& knowledge, const Demand& demand, std::uint32_t number) {
    const LiftedMethod& method = knowledge.problem.methods[number];
    Rule rule = method_rule(knowledge, demand, number);
    rule.result = Pattern{knowledge.task_relation(method.task), method.task_arguments};
    return rule;
}

}  // namespace

void reach_tasks(Knowledge& knowledge, const Demand& demand, Limits& limits) {
    const LiftedProblem& problem = knowledge.problem;
    std::vector<std::uint32_t> method_of_rule;
    std::vector<ObjectId> arguments;
    const auto emit = [&](std::uint32_t rule, const Bindings& bindings) {
        const LiftedMethod& method = problem.methods[method_of_rule[rule]];
        arguments.clear();
        for (const Term term : method.task_arguments) {
            arguments.push_back(object_of(term, bindings));
        }
        knowledge.relations[knowledge.task_relation(method.task)].add(arguments);
    };
    std::vector<bool> grows(knowledge.relations.size(), false);
    for (auto task = static_cast<std::uint32_t>(problem.actions.size()); task < knowledge.task_count(); ++task) {
        grows[knowledge.task_relation(task)] = true;
    }
    JoinEngine engine(knowledge, std::move(grows), limits, emit);
    std::vector<std::uint32_t> initial_methods;
    for (std::uint32_t method = 0; method < problem.methods.size(); ++method) {
        if (demand.is_method_demanded[method] && problem.methods[method].task == problem.initial_task) {
            initial_methods.push_back(method);
        } else if (demand.is_method_demanded[method]) {
            method_of_rule.push_back(method);
            engine.add_rule(accomplishing_rule(knowledge, demand, method));
        }
    }
    engine.run();
    // No method contains the initial task, and its network may be long: it is enough to evaluate it once, at the end.
    const std::vector<bool> nothing_grows(knowledge.relations.size(), false);
    Joiner joiner(knowledge, limits, emit);
    for (const std::uint32_t method : initial_methods) {
        const auto number = static_cast<std::uint32_t>(method_of_rule.size());
        method_of_rule.push_back(method);
        const Rule rule = accomplishing_rule(knowledge, demand, method);
        joiner.run(rule, plan_join(knowledge, nothing_grows, rule, number, std::nullopt, limits), std::nullopt);
    }
}

}  // namespace relax::grounding
