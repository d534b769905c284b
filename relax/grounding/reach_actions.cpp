#include <algorithm>
#include <numeric>

#include "formulas.hpp"
#include "join.hpp"
#include "reachability.hpp"
#include "truth.hpp"

namespace relax::grounding {

namespace {

std::vector<Term> parameter_terms(std::size_t count) {
    std::vector<Term> terms(count);
    std::iota(terms.begin(), terms.end(), 0);
    return terms;
}

class ActionReachability {
public:
    ActionReachability(Knowledge& knowledge, const Demand& demand, Limits& limits)
        : knowledge_(knowledge),
          demand_(demand),
          limits_(limits),
          engine_(knowledge, growing_relations(knowledge, demand), limits,
                  [this](std::uint32_t rule, Bindings& bindings) { emit(rule, bindings); }) {}

    Dependents run() {
        for (std::uint32_t action = 0; action < knowledge_.problem.actions.size(); ++action) {
            if (demand_.is_demanded[action]) {
                add_rules(action);
            }
        }
        do {
            engine_.run();
        } while (wake_waiting());
        return std::move(dependents_);
    }

private:
    // What a rule derives. A residual condition, which no join can use, is tested
    // again whenever one of the predicates that it waits for has grown.
    struct Head {
        explicit Head(std::uint32_t of, std::optional<std::uint32_t> part = std::nullopt)
            : action(of), dependent(part) {}

        std::uint32_t action;
        std::optional<std::uint32_t> dependent;  // none: the action itself
        Formula residual;
        std::vector<std::uint32_t> awaited;
        std::uint64_t seen = 0;         // size of the awaited predicates at the last test
        std::vector<ObjectId> waiting;  // bindings one after the other
        std::size_t waiting_count = 0;
    };

    static std::vector<bool> growing_relations(const Knowledge& knowledge, const Demand& demand) {
        std::vector<bool> grows = knowledge.grows;
        for (std::uint32_t task = 0; task < knowledge.task_count(); ++task) {
            grows.push_back(knowledge.is_action(task) && demand.is_demanded[task]);
        }
        grows.resize(knowledge.relations.size(), false);
        return grows;
    }

    void add_rules(std::uint32_t number) {
        const LiftedAction& action = knowledge_.problem.actions[number];
        Rule rule;
        rule.slot_count = action.slot_count;
        rule.domains.assign(action.slot_count, nullptr);
        for (std::uint32_t slot = 0; slot < action.parameters.size(); ++slot) {
            rule.domains[slot] = &demand_.arguments[number][slot];
            rule.head.push_back(slot);
        }
        for (const PairRelation& pairs : demand_.pair_relations[number]) {
            rule.patterns.push_back(
                {pairs.relation, {static_cast<Term>(pairs.first), static_cast<Term>(pairs.second)}});
        }
        add_condition(std::move(rule), action.precondition, Head(number));
        for (std::uint32_t effect = 0; effect < action.effects.size(); ++effect) {
            if (!is_simple(action.effects[effect])) {
                add_dependent(number, effect, action.effects[effect].variables, action.effects[effect].condition);
            }
        }
        auto dependent = static_cast<std::uint32_t>(action.effects.size());
        for (const LiftedCostCondition& cost : action.cost_conditions) {
            add_dependent(number, dependent++, cost.variables, cost.condition);
        }
    }

    void add_dependent(std::uint32_t number, std::uint32_t dependent, const std::vector<LiftedVariable>& variables,
                       const Formula& condition) {
        const LiftedAction& action = knowledge_.problem.actions[number];
        Rule rule;
        rule.slot_count = action.slot_count;
        rule.domains.assign(action.slot_count, nullptr);
        rule.patterns.push_back({knowledge_.task_relation(number), parameter_terms(action.parameters.size())});
        for (const LiftedVariable& variable : variables) {
            rule.domains[variable.slot] = &knowledge_.domains[variable.domain];
            rule.head.push_back(variable.slot);
        }
        add_condition(std::move(rule), condition, Head(number, dependent));
    }

    // Atoms with variables become patterns, what cannot change becomes a test,
    // and everything else waits. (A goal may have hundreds of atoms without
    // variables, each of which would trigger the joins of all others.)
    void add_condition(Rule rule, const Formula& condition, Head head) {
        std::vector<Formula> conjuncts;
        split_conjunction(normal_form(knowledge_, condition), conjuncts);
        for (Formula& conjunct : conjuncts) {
            const std::size_t awaited = head.awaited.size();
            const auto is_variable = [](Term term) { return term >= 0; };
            if (conjunct.kind == FormulaKind::Atom && std::ranges::any_of(conjunct.terms, is_variable)) {
                rule.patterns.push_back({conjunct.symbol, conjunct.terms});
                continue;
            }
            awaited_predicates(knowledge_, conjunct, head.awaited);
            if (head.awaited.size() > awaited) {
                head.residual.operands.push_back(std::move(conjunct));
            } else {
                rule.tests.push_back(std::move(conjunct));
            }
        }
        std::ranges::sort(head.awaited);
        const auto repeated = std::ranges::unique(head.awaited);
        head.awaited.erase(repeated.begin(), repeated.end());
        heads_.push_back(std::move(head));
        engine_.add_rule(std::move(rule));
    }

    void emit(std::uint32_t rule, Bindings& bindings) {
        Head& head = heads_[rule];
        if (is_true(head.residual) || is_relaxed_true(knowledge_, limits_, head.residual, bindings)) {
            derive(head, bindings);
        } else {
            const std::size_t slots = knowledge_.problem.actions[head.action].slot_count;
            head.waiting.insert(head.waiting.end(), bindings.begin(),
                                bindings.begin() + static_cast<std::ptrdiff_t>(slots));
            ++head.waiting_count;
        }
    }

    void derive(const Head& head, const Bindings& bindings) {
        const LiftedAction& action = knowledge_.problem.actions[head.action];
        const std::span<const ObjectId> arguments(bindings.data(), action.parameters.size());
        const TupleId instance = knowledge_.relations[knowledge_.task_relation(head.action)].add(arguments);
        if (!head.dependent) {
            for (const LiftedEffect& effect : action.effects) {
                if (is_simple(effect)) {
                    add_fact(effect, bindings);
                }
            }
            return;
        }
        dependents_.keys.push_back({head.action, instance, *head.dependent});
        const bool is_effect = *head.dependent < action.effects.size();
        for (const LiftedVariable& variable :
             is_effect ? action.effects[*head.dependent].variables
                       : action.cost_conditions[*head.dependent - action.effects.size()].variables) {
            dependents_.objects.push(bindings[variable.slot]);
        }
        dependents_.objects.finish_row();
        if (is_effect) {
            add_fact(action.effects[*head.dependent], bindings);
        }
    }

    void add_fact(const LiftedEffect& effect, const Bindings& bindings) {
        if (effect.positive) {
            std::vector<ObjectId> fact;
            fact.reserve(effect.arguments.size());
            for (const Term term : effect.arguments) {
                fact.push_back(object_of(term, bindings));
            }
            knowledge_.relations[effect.predicate].add(fact);
        }
    }

    // Returns whether it has derived something new.
    bool wake_waiting() {
        bool woken = false;
        for (Head& head : heads_) {
            std::uint64_t size = 0;
            for (const std::uint32_t predicate : head.awaited) {
                size += knowledge_.relations[predicate].size();
            }
            if (head.waiting_count == 0 || size == head.seen) {
                continue;
            }
            head.seen = size;
            const std::size_t slots = knowledge_.problem.actions[head.action].slot_count;
            const std::vector<ObjectId> waiting = std::move(head.waiting);
            const std::size_t count = std::exchange(head.waiting_count, 0);
            head.waiting.clear();
            for (std::size_t at = 0; at < count; ++at) {
                Bindings bindings(waiting.begin() + static_cast<std::ptrdiff_t>(at * slots),
                                  waiting.begin() + static_cast<std::ptrdiff_t>((at + 1) * slots));
                emit(static_cast<std::uint32_t>(&head - heads_.data()), bindings);
            }
            woken = woken || head.waiting_count < count;
        }
        return woken;
    }

    Knowledge& knowledge_;
    const Demand& demand_;
    Limits& limits_;
    std::vector<Head> heads_;  // by rule
    Dependents dependents_;
    JoinEngine engine_;
};

}  // namespace

bool is_simple(const LiftedEffect& effect) {
    std::vector<Formula> conjuncts;
    split_conjunction(effect.condition, conjuncts);
    return conjuncts.empty() && effect.variables.empty();
}

void classify_predicates(Knowledge& knowledge, const std::vector<bool>& is_demanded) {
    knowledge.grows.assign(knowledge.problem.predicate_count, false);
    knowledge.shrinks.assign(knowledge.problem.predicate_count, false);
    for (std::size_t action = 0; action < knowledge.problem.actions.size(); ++action) {
        if (is_demanded[action]) {
            for (const LiftedEffect& effect : knowledge.problem.actions[action].effects) {
                (effect.positive ? knowledge.grows : knowledge.shrinks)[effect.predicate] = true;
            }
        }
    }
}

Dependents reach_actions(Knowledge& knowledge, const Demand& demand, Limits& limits) {
    return ActionReachability(knowledge, demand, limits).run();
}

}  // namespace relax::grounding
