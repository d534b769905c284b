// The rules of Reachability: one for each action, from its precondition, and one for each method, from its subtasks.

#include <algorithm>

#include "reachability.hpp"

namespace relax {

void Reachability::find_static_predicates() {
    is_added_.assign(problem_.predicate_count, false);
    is_deleted_.assign(problem_.predicate_count, false);
    for (const LiftedAction& action : problem_.actions) {
        for (const LiftedEffect& effect : action.effects) {
            (effect.positive ? is_added_ : is_deleted_)[effect.predicate] = true;
        }
    }
}

void Reachability::add_initial_state() {
    std::vector<std::size_t> arity(problem_.predicate_count, 0);
    const auto note_atoms = [&](const auto& self, const Formula& formula) -> void {
        if (formula.kind == FormulaKind::Atom) {
            arity[formula.symbol] = formula.terms.size();
        }
        for (const Formula& operand : formula.operands) {
            self(self, operand);
        }
    };
    for (const LiftedAction& action : problem_.actions) {
        note_atoms(note_atoms, action.precondition);
        for (const LiftedEffect& effect : action.effects) {
            arity[effect.predicate] = effect.arguments.size();
            note_atoms(note_atoms, effect.condition);
        }
        for (const LiftedCostCondition& condition : action.cost_conditions) {
            note_atoms(note_atoms, condition.condition);
        }
    }
    for (const auto& fact : problem_.initial_state) {
        arity[fact[0]] = fact.size() - 1;
    }
    for (const std::size_t count : arity) {
        relations_.emplace_back(count);
    }
    for (const auto& fact : problem_.initial_state) {
        relations_[fact[0]].insert(std::span(fact).subspan(1));
    }
    for (std::uint32_t predicate = 0; predicate < problem_.predicate_count; ++predicate) {
        initial_count_.push_back(relations_[predicate].size());
        while (is_static(predicate) && relations_[predicate].shown() < relations_[predicate].size()) {
            relations_[predicate].show_next();
        }
    }
    for (const LiftedAction& action : problem_.actions) {
        relations_.emplace_back(action.parameters.size());
    }
    for (const LiftedTask& task : problem_.tasks) {
        relations_.emplace_back(task.parameters.size());
    }
}

void Reachability::add_action_rule(std::uint32_t schema) {
    const LiftedAction& action = problem_.actions[schema];
    TaskRule& rule = rules_.emplace_back();
    rule.rule.parameters = action.parameters;
    rule.rule.slot_count = action.slot_count;
    rule.schema = schema;
    rule.is_method = false;
    for (std::uint32_t slot = 0; slot < action.parameters.size(); ++slot) {
        rule.head.push_back(static_cast<Term>(slot));
    }
    add_condition(rule, action.precondition);
    bind_irrelevant(rule);
}

void Reachability::add_method_rule(std::uint32_t schema) {
    const LiftedMethod& method = problem_.methods[schema];
    TaskRule& rule = rules_.emplace_back();
    rule.rule.parameters = method.parameters;
    rule.rule.slot_count = method.slot_count;
    rule.schema = schema;
    rule.is_method = true;
    rule.head = method.task_arguments;
    for (const LiftedSubtask& subtask : method.subtasks) {
        rule.rule.body.push_back({problem_.predicate_count + subtask.task, subtask.arguments});
    }
    // The task's parameters may be of narrower types than the method's.
    const auto& types = problem_.tasks[method.task - problem_.actions.size()].parameters;
    for (std::size_t position = 0; position < types.size(); ++position) {
        Formula narrow{FormulaKind::InDomain, {}, types[position], {method.task_arguments[position]}, {}};
        rule.rule.filters.push_back({free_slots(narrow), [this, narrow](std::span<const ObjectId> binding) {
                                         return domains_.contains(narrow.symbol, value_of(narrow.terms[0], binding));
                                     }});
    }
    add_condition(rule, method.constraints);
    bind_irrelevant(rule);
}

// Sort the conjuncts of a condition: atoms are joined, what reads no fluents filters, the rest waits.
void Reachability::add_condition(TaskRule& rule, const Formula& formula) {
    if (formula.kind == FormulaKind::And) {
        for (const Formula& operand : formula.operands) {
            add_condition(rule, operand);
        }
    } else if (formula.kind == FormulaKind::Atom) {
        rule.rule.body.push_back({formula.symbol, formula.terms});
    } else if (has_fluent(formula)) {
        rule.residual.push_back(&formula);
    } else {
        rule.rule.filters.push_back({free_slots(formula), [this, &formula](std::span<const ObjectId> binding) {
                                         Binding extended(binding.begin(), binding.end());
                                         return is_possible(formula, extended, false);
                                     }});
    }
}

// A parameter that nothing mentions may be any object of its domain: the first one stands for all.
void Reachability::bind_irrelevant(TaskRule& rule) {
    std::vector<bool> relevant(rule.rule.slot_count, false);
    const auto note = [&](const std::vector<Term>& terms) {
        for (const Term term : terms) {
            if (term >= 0) {
                relevant[static_cast<std::size_t>(term)] = true;
            }
        }
    };
    note(rule.head);
    for (const auto& atom : rule.rule.body) {
        note(atom.terms);
    }
    for (const auto& filter : rule.rule.filters) {
        for (const std::uint32_t slot : filter.slots) {
            relevant[slot] = true;
        }
    }
    rule.start.assign(rule.rule.slot_count, kUnbound);
    for (std::uint32_t slot = 0; slot < rule.rule.parameters.size(); ++slot) {
        if (!relevant[slot]) {
            const auto objects = domains_.objects(rule.rule.parameters[slot]);
            rule.can_fire = rule.can_fire && !objects.empty();
            rule.start[slot] = objects.empty() ? kUnbound : objects.front();
        }
    }
}

void Reachability::make_triggers() {
    triggers_.resize(relations_.size());
    for (std::size_t number = 0; number < rules_.size(); ++number) {
        TaskRule& rule = rules_[number];
        if (!rule.can_fire) {
            continue;
        }
        std::vector<bool> bound(rule.rule.slot_count, false);
        for (std::size_t slot = 0; slot < bound.size(); ++slot) {
            bound[slot] = rule.start[slot] != kUnbound;
        }
        bool is_triggered = false;
        for (std::size_t atom = 0; atom < rule.rule.body.size(); ++atom) {
            const std::uint32_t relation = rule.rule.body[atom].relation;
            if (relation < problem_.predicate_count && is_static(relation)) {
                continue;
            }
            is_triggered = true;
            std::vector<bool> bound_then = bound;
            for (const Term term : rule.rule.body[atom].terms) {
                if (term >= 0) {
                    bound_then[static_cast<std::size_t>(term)] = true;
                }
            }
            triggers_[relation].push_back({number, atom, JoinPlan(rule.rule, bound_then, atom, relations_, domains_)});
        }
        if (!is_triggered) {
            const JoinPlan plan(rule.rule, bound, std::nullopt, relations_, domains_);
            Binding binding = rule.start;
            plan.run(binding, [&](std::span<const ObjectId> solution) {
                fire(number, solution);
                return true;
            });
        }
    }
}

}  // namespace relax
