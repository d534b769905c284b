#include "literals.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "truth.hpp"

namespace relax::grounding {

namespace {

constexpr std::size_t kMostComparedCases = 300;  // subsumption compares all pairs

const Disjunction kTrue{Conjunction{}};
const Disjunction kFalse{};

Disjunction product(const Disjunction& left, const Disjunction& right) {
    Disjunction result;
    for (const Conjunction& one : left) {
        for (const Conjunction& other : right) {
            Conjunction both = one;
            both.insert(both.end(), other.begin(), other.end());
            if (auto conjunction = normalized(std::move(both))) {
                result.push_back(*std::move(conjunction));
                check_case_count(result.size());
            }
        }
    }
    drop_subsumed(result);
    return result;
}

}  // namespace

std::optional<Conjunction> normalized(Conjunction literals) {
    std::ranges::sort(literals);
    const auto repeated = std::ranges::unique(literals);
    literals.erase(repeated.begin(), repeated.end());
    const auto contradict = [](Literal left, Literal right) { return fact_of(left) == fact_of(right); };
    if (std::ranges::adjacent_find(literals, contradict) != literals.end()) {
        return std::nullopt;
    }
    return literals;
}

Disjunction conjoin(std::vector<Disjunction> parts) {
    // First the operands with a single case, all at once; then the others, those with few cases first.
    Conjunction certain;
    std::vector<Disjunction> open;
    for (Disjunction& part : parts) {
        if (part.size() == 1) {
            certain.insert(certain.end(), part[0].begin(), part[0].end());
        } else {
            open.push_back(std::move(part));
        }
    }
    auto conjunction = normalized(std::move(certain));
    if (!conjunction) {
        return kFalse;
    }
    Disjunction result{*std::move(conjunction)};
    std::ranges::stable_sort(open, {}, &Disjunction::size);
    for (const Disjunction& part : open) {
        result = product(result, part);
    }
    return result;
}

Disjunction negate(const Disjunction& cases) {
    std::vector<Disjunction> parts;
    for (const Conjunction& conjunction : cases) {
        Disjunction& part = parts.emplace_back();
        for (const Literal literal : conjunction) {
            part.push_back({negation(literal)});
        }
    }
    return conjoin(std::move(parts));
}

void drop_subsumed(Disjunction& cases) {
    std::ranges::stable_sort(cases, [](const Conjunction& left, const Conjunction& right) {
        return left.size() != right.size() ? left.size() < right.size() : left < right;
    });
    const auto repeated = std::ranges::unique(cases);
    cases.erase(repeated.begin(), repeated.end());
    if (cases.size() > kMostComparedCases) {
        return;
    }
    Disjunction kept;
    for (Conjunction& candidate : cases) {
        if (std::ranges::none_of(kept,
                                 [&](const Conjunction& other) { return std::ranges::includes(candidate, other); })) {
            kept.push_back(std::move(candidate));
        }
    }
    cases = std::move(kept);
}

Expander::Expander(const Knowledge& knowledge, Limits& limits) : knowledge_(knowledge), limits_(limits) {
    begin_.push_back(0);
    for (std::uint32_t predicate = 0; predicate < knowledge.problem.predicate_count; ++predicate) {
        const bool changes = knowledge.grows[predicate] || knowledge.shrinks[predicate];
        begin_.push_back(begin_.back() + (changes ? knowledge.relations[predicate].size() : 0));
    }
}

std::optional<ReachedFactId> Expander::fact(std::uint32_t predicate, const std::vector<Term>& terms,
                                            const Bindings& bindings) const {
    assert(predicate + 1 < begin_.size());
    if (begin_[predicate] == begin_[predicate + 1]) {
        return std::nullopt;
    }
    std::vector<ObjectId> objects;
    objects.reserve(terms.size());
    for (const Term term : terms) {
        objects.push_back(object_of(term, bindings));
    }
    const auto tuple = knowledge_.relations[predicate].find(objects);
    return tuple ? std::optional(ReachedFactId(begin_[predicate] + *tuple)) : std::nullopt;
}

Disjunction Expander::expand_atom(const Formula& atom, bool negated, const Bindings& bindings) const {
    std::vector<ObjectId> objects;
    objects.reserve(atom.terms.size());
    for (const Term term : atom.terms) {
        objects.push_back(object_of(term, bindings));
    }
    assert(atom.kind == FormulaKind::Atom);
    const std::uint32_t predicate = atom.symbol;
    const auto tuple = knowledge_.relations[predicate].find(objects);
    if (!tuple) {
        return negated ? kTrue : kFalse;
    }
    if (!knowledge_.shrinks[predicate] && is_initially_true(predicate, *tuple)) {
        return negated ? kFalse : kTrue;
    }
    return {{literal_of(ReachedFactId(begin_[predicate] + *tuple), negated)}};
}

Disjunction Expander::expand(const Formula& formula, Bindings& bindings) const {
    const auto truth = [](bool value) { return value ? kTrue : kFalse; };
    std::vector<Disjunction> parts;
    const auto add_part = [&](const Formula& operand, const Disjunction& decisive) {
        parts.push_back(expand(operand, bindings));
        return parts.back() == decisive;  // the rest does not matter
    };
    const auto disjoin = [&] {
        Disjunction result;
        for (Disjunction& part : parts) {
            std::ranges::move(part, std::back_inserter(result));
            check_case_count(result.size());
        }
        drop_subsumed(result);
        return result;
    };
    switch (formula.kind) {
        case FormulaKind::Atom:
            return expand_atom(formula, false, bindings);
        case FormulaKind::Not:
            if (formula.operands[0].kind == FormulaKind::Atom) {
                return expand_atom(formula.operands[0], true, bindings);
            }
            [[fallthrough]];
        case FormulaKind::Equals:
        case FormulaKind::InDomain:
            return truth(is_relaxed_true(knowledge_, limits_, formula, bindings));
        case FormulaKind::And: {
            const auto decide = [&](const Formula& operand) { return add_part(operand, kFalse); };
            return std::ranges::any_of(formula.operands, decide) ? kFalse : conjoin(std::move(parts));
        }
        case FormulaKind::Or: {
            const auto decide = [&](const Formula& operand) { return add_part(operand, kTrue); };
            return std::ranges::any_of(formula.operands, decide) ? kTrue : disjoin();
        }
        case FormulaKind::Forall: {
            const auto decide = [&] { return add_part(formula.operands[0], kFalse); };
            return Matcher(knowledge_, limits_, formula).any(bindings, decide) ? kFalse : conjoin(std::move(parts));
        }
        case FormulaKind::Exists: {
            const auto decide = [&] { return add_part(formula.operands[0], kTrue); };
            return Matcher(knowledge_, limits_, formula).any(bindings, decide) ? kTrue : disjoin();
        }
    }
    return kFalse;
}

}  // namespace relax::grounding
