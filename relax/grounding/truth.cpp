#include "truth.hpp"

#include <algorithm>

namespace relax::grounding {

namespace {

std::optional<TupleId> find_atom(const Knowledge& knowledge, const Formula& atom, const Bindings& bindings) {
    std::vector<ObjectId> objects;
    objects.reserve(atom.terms.size());
    for (const Term term : atom.terms) {
        objects.push_back(object_of(term, bindings));
    }
    return knowledge.relations[atom.symbol].find(objects);
}

bool is_relaxed_false(const Knowledge& knowledge, Limits& limits, const Formula& leaf, Bindings& bindings) {
    if (leaf.kind != FormulaKind::Atom) {
        return !is_relaxed_true(knowledge, limits, leaf, bindings);
    }
    if (knowledge.shrinks[leaf.symbol]) {
        return true;
    }
    const auto tuple = find_atom(knowledge, leaf, bindings);
    return !tuple || *tuple >= knowledge.initial_count[leaf.symbol];
}

bool is_unbound(Term term, const std::vector<LiftedVariable>& unbound) {
    return term >= 0 && std::ranges::any_of(unbound, [term](LiftedVariable variable) {
               return variable.slot == static_cast<std::uint32_t>(term);
           });
}

}  // namespace

bool is_relaxed_true(const Knowledge& knowledge, Limits& limits, const Formula& formula, Bindings& bindings) {
    const auto holds = [&](const Formula& operand) { return is_relaxed_true(knowledge, limits, operand, bindings); };
    switch (formula.kind) {
        case FormulaKind::And:
            return std::ranges::all_of(formula.operands, holds);
        case FormulaKind::Or:
            return std::ranges::any_of(formula.operands, holds);
        case FormulaKind::Not:
            return is_relaxed_false(knowledge, limits, formula.operands[0], bindings);
        case FormulaKind::Atom:
            return find_atom(knowledge, formula, bindings).has_value();
        case FormulaKind::Equals:
            return object_of(formula.terms[0], bindings) == object_of(formula.terms[1], bindings);
        case FormulaKind::InDomain:
            return knowledge.domains[formula.symbol].contains(object_of(formula.terms[0], bindings));
        case FormulaKind::Exists:
            return Matcher(knowledge, limits, formula).any(bindings, [&] { return holds(formula.operands[0]); });
        case FormulaKind::Forall:
            return !Matcher(knowledge, limits, formula).any(bindings, [&] { return !holds(formula.operands[0]); });
    }
    return false;
}

Matcher::Matcher(const Knowledge& knowledge, Limits& limits, const Formula& quantifier)
    : knowledge_(knowledge), limits_(limits), variables_(quantifier.variables) {
    const bool is_exists = quantifier.kind == FormulaKind::Exists;
    const auto add = [&](const Formula& part) {
        if (is_exists && part.kind == FormulaKind::Atom) {
            guides_.push_back(&part);
        } else if (!is_exists && part.kind == FormulaKind::Not && part.operands[0].kind == FormulaKind::Atom) {
            guides_.push_back(&part.operands[0]);
        }
    };
    const Formula& body = quantifier.operands[0];
    if (body.kind == (is_exists ? FormulaKind::And : FormulaKind::Or)) {
        std::ranges::for_each(body.operands, add);
    } else {
        add(body);
    }
}

Matcher::Choice Matcher::choose(const Variables& unbound, const Bindings& bindings) {
    Choice best;
    best.variable = *std::ranges::min_element(
        unbound, {}, [this](LiftedVariable variable) { return knowledge_.domains[variable.domain].size(); });
    best.objects = knowledge_.domains[best.variable.domain].members();
    std::size_t fewest = best.objects.size();
    for (const Formula* guide : guides_) {
        positions_.clear();
        key_.clear();
        for (std::uint32_t position = 0; position < guide->terms.size(); ++position) {
            const Term term = guide->terms[position];
            if (!is_unbound(term, unbound)) {
                positions_.push_back(position);
                key_.push_back(object_of(term, bindings));
            }
        }
        if (positions_.size() == guide->terms.size()) {
            continue;
        }
        const Relation& relation = knowledge_.relations[guide->symbol];
        const IndexId index = relation.complete_index_on(positions_, limits_);
        const std::size_t count = relation.count(index, key_);
        if (count < fewest || (count == fewest && best.atom == nullptr)) {
            fewest = count;
            best.atom = guide;
            best.index = index;
            best.first = relation.first(index, key_);
        }
    }
    return best;
}

std::optional<Matcher::Variables> Matcher::bind(const Formula& atom, std::span<const ObjectId> tuple,
                                                const Variables& unbound, Bindings& bindings) const {
    Variables rest = unbound;
    for (std::size_t position = 0; position < tuple.size(); ++position) {
        const Term term = atom.terms[position];
        if (!is_unbound(term, unbound)) {
            continue;
        }
        const auto slot = static_cast<std::uint32_t>(term);
        const auto open = std::ranges::find(rest, slot, &LiftedVariable::slot);
        if (open == rest.end()) {  // the variable stands twice in the atom
            if (bindings[slot] != tuple[position]) {
                return std::nullopt;
            }
            continue;
        }
        if (!knowledge_.domains[open->domain].contains(tuple[position])) {
            return std::nullopt;
        }
        bindings[slot] = tuple[position];
        rest.erase(open);
    }
    return rest;
}

}  // namespace relax::grounding
