#include "reachability.hpp"

#include <algorithm>

namespace relax {

namespace {

void collect_free_slots(const Formula& formula, std::vector<std::uint32_t>& slots) {
    for (const Term term : formula.terms) {
        if (term >= 0) {
            slots.push_back(static_cast<std::uint32_t>(term));
        }
    }
    for (const Formula& operand : formula.operands) {
        collect_free_slots(operand, slots);
    }
    for (const LiftedVariable& variable : formula.variables) {
        std::erase(slots, variable.slot);
    }
}

}  // namespace

std::vector<std::uint32_t> free_slots(const Formula& formula) {
    std::vector<std::uint32_t> slots;
    collect_free_slots(formula, slots);
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    return slots;
}

Reachability::Reachability(const LiftedProblem& problem, Limits& limits)
    : problem_(problem), limits_(limits), domains_(problem), methods_of_(problem.tasks.size()) {
    find_static_predicates();
    add_initial_state();
    for (std::uint32_t schema = 0; schema < problem.actions.size(); ++schema) {
        add_action_rule(schema);
        candidates_.emplace_back(problem.actions[schema].parameters.size());
    }
    for (std::uint32_t schema = 0; schema < problem.methods.size(); ++schema) {
        add_method_rule(schema);
        methods_of_[problem.methods[schema].task - problem.actions.size()].push_back(schema);
    }
    make_triggers();
}

void Reachability::run() {
    saturate();
    for (const Relation& relation : relations_) {
        is_needed_.emplace_back(relation.size(), false);
    }
    is_needed_.erase(is_needed_.begin(), is_needed_.begin() + problem_.predicate_count);
    const auto initial = instances(problem_.initial_task).find({});
    if (!initial) {
        return;
    }
    for (std::uint32_t schema = 0; schema < problem_.methods.size(); ++schema) {
        const TaskRule& rule = rules_[problem_.actions.size() + schema];
        std::vector<bool> bound(rule.rule.slot_count, false);
        for (std::uint32_t slot = 0; slot < bound.size(); ++slot) {
            bound[slot] = rule.start[slot] != kUnbound ||
                          std::find(rule.head.begin(), rule.head.end(), static_cast<Term>(slot)) != rule.head.end();
        }
        method_plans_.emplace_back();
        method_plans_.back().emplace_back(rule.rule, std::move(bound), std::nullopt, relations_, domains_);
    }
    need({problem_.initial_task, *initial});
    for (std::size_t next = 0; next < needed_.size(); ++next) {
        if (needed_[next].task >= problem_.actions.size()) {
            expand(needed_[next]);
        }
    }
}

void Reachability::check_limits() {
    if (const auto reason = limits_.check()) {
        throw GroundingStopped{*reason};
    }
}

void Reachability::saturate() {
    for (bool changed = true; changed;) {
        show_new_tuples();
        changed = false;
        std::vector<TaskInstance> retried;
        retried.swap(waiting_);
        for (const TaskInstance& candidate : retried) {
            changed = try_action(candidate.task, candidate.tuple) || changed;
        }
        retried.clear();
        retried.swap(unfinished_);
        for (const TaskInstance& action : retried) {
            const auto tuple = instances(action.task)[action.tuple];
            const std::vector<ObjectId> arguments(tuple.begin(), tuple.end());
            if (!apply_effects(action.task, arguments)) {
                unfinished_.push_back(action);
            }
        }
        for (const Relation& relation : relations_) {
            changed = changed || relation.shown() < relation.size();
        }
    }
}

void Reachability::show_new_tuples() {
    for (bool changed = true; changed;) {
        changed = false;
        for (std::uint32_t number = 0; number < relations_.size(); ++number) {
            while (relations_[number].shown() < relations_[number].size()) {
                changed = true;
                check_limits();
                const auto id = static_cast<TupleId>(relations_[number].shown());
                relations_[number].show_next();
                const auto objects = relations_[number][id];
                const std::vector<ObjectId> tuple(objects.begin(), objects.end());
                for (const Trigger& trigger : triggers_[number]) {
                    const TaskRule& rule = rules_[trigger.rule];
                    Binding binding = rule.start;
                    if (unify(rule.rule.body[trigger.atom].terms, tuple, rule.rule, domains_, binding)) {
                        trigger.plan.run(binding, [&](std::span<const ObjectId> solution) {
                            fire(trigger.rule, solution);
                            return true;
                        });
                    }
                }
            }
        }
    }
}

void Reachability::fire(std::size_t number, std::span<const ObjectId> binding) {
    check_limits();
    const TaskRule& rule = rules_[number];
    std::vector<ObjectId> head;
    head.reserve(rule.head.size());
    for (const Term term : rule.head) {
        head.push_back(value_of(term, binding));
    }
    if (rule.is_method) {
        relations_[problem_.predicate_count + problem_.methods[rule.schema].task].insert(head);
    } else if (const auto [candidate, is_new] = candidates_[rule.schema].insert(head); is_new) {
        try_action(rule.schema, candidate);
    }
}

// Make a candidate an instance if its remaining conditions are possible, else let it wait.
bool Reachability::try_action(std::uint32_t schema, TupleId candidate) {
    const auto tuple = candidates_[schema][candidate];
    Binding binding(tuple.begin(), tuple.end());
    const std::vector<ObjectId> arguments = binding;
    binding.resize(problem_.actions[schema].slot_count, kUnbound);
    for (const Formula* formula : rules_[schema].residual) {
        if (!is_possible(*formula, binding, false)) {
            waiting_.push_back({schema, candidate});
            return false;
        }
    }
    const TupleId id = relations_[problem_.predicate_count + schema].insert(arguments).first;
    if (!apply_effects(schema, arguments)) {
        unfinished_.push_back({schema, id});
    }
    return true;
}

// Add the facts that the action can make true. False if some condition is not possible yet.
bool Reachability::apply_effects(std::uint32_t schema, std::span<const ObjectId> arguments) {
    Binding binding(arguments.begin(), arguments.end());
    binding.resize(problem_.actions[schema].slot_count, kUnbound);
    bool all = true;
    std::vector<ObjectId> fact;
    for (const LiftedEffect& effect : problem_.actions[schema].effects) {
        if (!effect.positive) {
            continue;
        }
        for_all_objects(effect.variables, domains_, binding, [&] {
            if (is_possible(effect.condition, binding, false)) {
                fact.clear();
                for (const Term term : effect.arguments) {
                    fact.push_back(value_of(term, binding));
                }
                relations_[effect.predicate].insert(fact);
            } else {
                all = false;
            }
            return true;
        });
    }
    return all;
}

// Make the instances of all methods of a compound task instance.
void Reachability::expand(TaskInstance instance) {
    const auto objects = instances(instance.task)[instance.tuple];
    const std::vector<ObjectId> arguments(objects.begin(), objects.end());
    for (const std::uint32_t schema : methods_of_[instance.task - problem_.actions.size()]) {
        const LiftedMethod& method = problem_.methods[schema];
        const TaskRule& rule = rules_[problem_.actions.size() + schema];
        Binding binding = rule.start;
        if (!rule.can_fire || !unify(rule.head, arguments, rule.rule, domains_, binding)) {
            continue;
        }
        method_plans_[schema].front().run(binding, [&](std::span<const ObjectId> solution) {
            check_limits();
            MethodInstance made{
                schema,
                instance,
                {solution.begin(), solution.begin() + static_cast<std::ptrdiff_t>(method.parameters.size())},
                {}};
            std::vector<ObjectId> tuple;
            for (const LiftedSubtask& subtask : method.subtasks) {
                tuple.clear();
                for (const Term term : subtask.arguments) {
                    tuple.push_back(value_of(term, solution));
                }
                made.subtasks.push_back({subtask.task, *instances(subtask.task).find(tuple)});
                need(made.subtasks.back());
            }
            methods_.push_back(std::move(made));
            return true;
        });
    }
}

void Reachability::need(const TaskInstance& instance) {
    if (!is_needed_[instance.task][instance.tuple]) {
        is_needed_[instance.task][instance.tuple] = true;
        needed_.push_back(instance);
    }
}

bool Reachability::has_fluent(const Formula& formula) const {
    return (formula.kind == FormulaKind::Atom && !is_static(formula.symbol)) ||
           std::any_of(formula.operands.begin(), formula.operands.end(),
                       [this](const Formula& operand) { return has_fluent(operand); });
}

bool Reachability::is_possible(const Formula& formula, Binding& binding, bool negated) const {
    const auto operand_is = [&](const Formula& operand) { return is_possible(operand, binding, negated); };
    const auto& operands = formula.operands;
    switch (formula.kind) {
        case FormulaKind::And:
        case FormulaKind::Or:
            return (formula.kind == FormulaKind::And) != negated
                       ? std::all_of(operands.begin(), operands.end(), operand_is)
                       : std::any_of(operands.begin(), operands.end(), operand_is);
        case FormulaKind::Not:
            return is_possible(operands.front(), binding, !negated);
        case FormulaKind::Equals:
            return (value_of(formula.terms[0], binding) == value_of(formula.terms[1], binding)) != negated;
        case FormulaKind::InDomain:
            return domains_.contains(formula.symbol, value_of(formula.terms[0], binding)) != negated;
        case FormulaKind::Forall:
        case FormulaKind::Exists: {
            const bool all = (formula.kind == FormulaKind::Forall) != negated;
            return for_all_objects(formula.variables, domains_, binding,
                                   [&] { return operand_is(operands.front()) == all; }) == all;
        }
        case FormulaKind::Atom:
            break;
    }
    std::vector<ObjectId> tuple;
    for (const Term term : formula.terms) {
        tuple.push_back(value_of(term, binding));
    }
    const auto id = facts(formula.symbol).find(tuple);
    if (!negated) {
        return id.has_value();
    }
    return is_deleted_[formula.symbol] || !id || *id >= initial_count_[formula.symbol];
}

}  // namespace relax
