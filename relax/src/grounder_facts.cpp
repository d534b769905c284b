#include "grounder_facts.hpp"

#include <algorithm>

namespace relax::grounding {

Knowledge::Knowledge(const LiftedProblem& lifted)
    : problem(lifted), grows(lifted.predicate_count, false), shrinks(lifted.predicate_count, false) {
    for (const std::vector<ObjectId>& members : problem.domains) {
        ObjectSet& domain = domains.emplace_back(problem.object_count);
        for (const ObjectId object : members) {
            domain.add(object);
        }
    }
    std::vector<std::optional<std::size_t>> arities(problem.predicate_count);
    for (const std::vector<std::uint32_t>& fact : problem.initial_state) {
        arities[fact[0]] = fact.size() - 1;
    }
    for (const LiftedAction& action : problem.actions) {
        for (const LiftedEffect& effect : action.effects) {
            arities[effect.predicate] = effect.arguments.size();
        }
    }
    for (const std::optional<std::size_t>& arity : arities) {
        relations.emplace_back(arity.value_or(0));  // an empty relation's arity does not matter
    }
    for (const std::vector<std::uint32_t>& fact : problem.initial_state) {
        relations[fact[0]].add(std::span(fact).subspan(1));
    }
    for (const Relation& relation : relations) {
        initial_count.push_back(relation.size());
    }
    for (std::uint32_t task = 0; task < task_count(); ++task) {
        relations.emplace_back(task_parameters(task).size());
    }
}

Formula negation_normal_form(const Formula& formula, bool negated) {
    if (formula.kind == FormulaKind::Not) {
        return negation_normal_form(formula.operands[0], !negated);
    }
    Formula result;
    result.kind = formula.kind;
    result.symbol = formula.symbol;
    result.terms = formula.terms;
    result.variables = formula.variables;
    if (negated) {
        switch (formula.kind) {
            case FormulaKind::And:
                result.kind = FormulaKind::Or;
                break;
            case FormulaKind::Or:
                result.kind = FormulaKind::And;
                break;
            case FormulaKind::Exists:
                result.kind = FormulaKind::Forall;
                break;
            case FormulaKind::Forall:
                result.kind = FormulaKind::Exists;
                break;
            default: {
                Formula negation;
                negation.kind = FormulaKind::Not;
                negation.operands.push_back(std::move(result));
                return negation;
            }
        }
    }
    for (const Formula& operand : formula.operands) {
        result.operands.push_back(negation_normal_form(operand, negated));
    }
    return result;
}

void split_conjunction(const Formula& formula, std::vector<Formula>& conjuncts) {
    if (formula.kind != FormulaKind::And) {
        conjuncts.push_back(formula);
        return;
    }
    for (const Formula& operand : formula.operands) {
        split_conjunction(operand, conjuncts);
    }
}

void free_slots(const Formula& formula, std::vector<std::uint32_t>& slots) {
    for (const Term term : formula.terms) {
        if (term >= 0) {
            slots.push_back(static_cast<std::uint32_t>(term));
        }
    }
    for (const Formula& operand : formula.operands) {
        free_slots(operand, slots);
    }
    for (const LiftedVariable& variable : formula.variables) {  // every quantifier has slots of its own
        std::erase(slots, variable.slot);
    }
}

void awaited_predicates(const Knowledge& knowledge, const Formula& formula, std::vector<std::uint32_t>& predicates) {
    if (formula.kind == FormulaKind::Atom && knowledge.grows[formula.symbol]) {
        predicates.push_back(formula.symbol);
    }
    if (formula.kind != FormulaKind::Not) {
        for (const Formula& operand : formula.operands) {
            awaited_predicates(knowledge, operand, predicates);
        }
    }
}

namespace {

std::optional<TupleId> find_atom(const Knowledge& knowledge, const Formula& atom, const Bindings& bindings) {
    std::vector<ObjectId> objects;
    objects.reserve(atom.terms.size());
    for (const Term term : atom.terms) {
        objects.push_back(object_of(term, bindings));
    }
    return knowledge.relations[atom.symbol].find(objects);
}

bool is_relaxed_false(const Knowledge& knowledge, const Formula& leaf, Bindings& bindings) {
    if (leaf.kind != FormulaKind::Atom) {
        return !is_relaxed_true(knowledge, leaf, bindings);
    }
    if (knowledge.shrinks[leaf.symbol]) {
        return true;
    }
    const auto tuple = find_atom(knowledge, leaf, bindings);
    return !tuple || *tuple >= knowledge.initial_count[leaf.symbol];
}

}  // namespace

bool is_relaxed_true(const Knowledge& knowledge, const Formula& formula, Bindings& bindings) {
    const auto holds = [&](const Formula& operand) { return is_relaxed_true(knowledge, operand, bindings); };
    switch (formula.kind) {
        case FormulaKind::And:
            return std::ranges::all_of(formula.operands, holds);
        case FormulaKind::Or:
            return std::ranges::any_of(formula.operands, holds);
        case FormulaKind::Not:
            return is_relaxed_false(knowledge, formula.operands[0], bindings);
        case FormulaKind::Atom:
            return find_atom(knowledge, formula, bindings).has_value();
        case FormulaKind::Equals:
            return object_of(formula.terms[0], bindings) == object_of(formula.terms[1], bindings);
        case FormulaKind::InDomain:
            return knowledge.domains[formula.symbol].contains(object_of(formula.terms[0], bindings));
        case FormulaKind::Exists:
            return any_binding(knowledge, formula.variables, bindings, [&] { return holds(formula.operands[0]); });
        case FormulaKind::Forall:
            return !any_binding(knowledge, formula.variables, bindings, [&] { return !holds(formula.operands[0]); });
    }
    return false;
}

}  // namespace relax::grounding
