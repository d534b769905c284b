#include "formulas.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace relax::grounding {

namespace {

FormulaKind dual(FormulaKind kind) {
    switch (kind) {
        case FormulaKind::And:
            return FormulaKind::Or;
        case FormulaKind::Or:
            return FormulaKind::And;
        case FormulaKind::Exists:
            return FormulaKind::Forall;
        case FormulaKind::Forall:
            return FormulaKind::Exists;
        default:
            return kind;
    }
}

// And or Or of parts, without nesting and without what is decided.
Formula connect(FormulaKind kind, std::vector<Formula> parts) {
    Formula result;
    result.kind = kind;
    for (Formula& part : parts) {
        if (part.kind == dual(kind) && part.operands.empty()) {
            return part;  // decides it all
        }
        if (part.kind == kind) {
            std::ranges::move(part.operands, std::back_inserter(result.operands));
        } else {
            result.operands.push_back(std::move(part));
        }
    }
    return result.operands.size() == 1 ? Formula(std::move(result.operands.front())) : result;
}

std::vector<std::uint32_t> free_slots_of(const Formula& formula) {
    std::vector<std::uint32_t> slots;
    free_slots(formula, slots);
    return slots;
}

class Normaliser {
public:
    explicit Normaliser(const Knowledge& knowledge) : knowledge_(knowledge) {}

    Formula run(const Formula& formula, bool negated) {
        switch (formula.kind) {
            case FormulaKind::Not:
                return run(formula.operands[0], !negated);
            case FormulaKind::And:
            case FormulaKind::Or: {
                std::vector<Formula> parts;
                for (const Formula& operand : formula.operands) {
                    parts.push_back(run(operand, negated));
                }
                return connect(negated ? dual(formula.kind) : formula.kind, std::move(parts));
            }
            case FormulaKind::Exists:
            case FormulaKind::Forall:
                return quantify(negated ? dual(formula.kind) : formula.kind, formula.variables,
                                run(formula.operands[0], negated));
            default:
                break;
        }
        if (!negated) {
            return formula;
        }
        Formula negation;
        negation.kind = FormulaKind::Not;
        negation.operands.push_back(formula);
        return negation;
    }

private:
    // Put a quantifier over a formula in normal form, as far inside as it goes.
    Formula quantify(FormulaKind kind, const std::vector<LiftedVariable>& variables, Formula body) {
        if (std::ranges::any_of(variables,
                                [&](LiftedVariable variable) { return knowledge_.domains[variable.domain].empty(); })) {
            return connect(kind == FormulaKind::Exists ? FormulaKind::Or : FormulaKind::And, {});
        }
        // `exists` goes with `or` and keeps `and` together where variables tie it; `forall` the other way round.
        const FormulaKind easy = kind == FormulaKind::Exists ? FormulaKind::Or : FormulaKind::And;
        if (body.kind == easy) {
            std::vector<Formula> parts;
            for (Formula& operand : body.operands) {
                parts.push_back(quantify(kind, variables, std::move(operand)));
            }
            return connect(easy, std::move(parts));
        }
        if (body.kind == dual(easy)) {
            return separate(kind, variables, std::move(body));
        }
        return wrap(kind, variables, std::move(body));
    }

    // Give parts that share no variables quantifiers of their own.
    Formula separate(FormulaKind kind, const std::vector<LiftedVariable>& variables, Formula body) {
        std::vector<std::vector<std::uint32_t>> slots;
        std::vector<std::size_t> group(body.operands.size());
        std::iota(group.begin(), group.end(), std::size_t{0});
        for (const Formula& operand : body.operands) {
            slots.push_back(free_slots_of(operand));
        }
        const auto mentions = [&](std::size_t part, LiftedVariable variable) {
            return std::ranges::find(slots[part], variable.slot) != slots[part].end();
        };
        for (const LiftedVariable& variable : variables) {
            std::optional<std::size_t> first;
            for (std::size_t part = 0; part < group.size(); ++part) {
                if (mentions(part, variable)) {
                    const std::size_t joined = group[part];
                    const std::size_t into = first ? group[*first] : joined;
                    std::ranges::replace(group, joined, into);
                    first = first.value_or(part);
                }
            }
        }
        std::vector<Formula> results;
        for (std::size_t leader = 0; leader < group.size(); ++leader) {
            std::vector<Formula> members;
            std::vector<LiftedVariable> own;
            for (const LiftedVariable& variable : variables) {
                for (std::size_t part = 0; part < group.size(); ++part) {
                    if (group[part] == leader && mentions(part, variable)) {
                        own.push_back(variable);
                        break;
                    }
                }
            }
            for (std::size_t part = 0; part < group.size(); ++part) {
                if (group[part] == leader) {
                    members.push_back(std::move(body.operands[part]));
                }
            }
            if (members.empty()) {
                continue;
            }
            const bool is_one = members.size() == 1;
            Formula together = connect(body.kind, std::move(members));
            // A part alone may let its quantifier further in.
            results.push_back(is_one && !own.empty() ? quantify(kind, own, std::move(together))
                                                     : wrap(kind, own, std::move(together)));
        }
        return connect(body.kind, std::move(results));
    }

    // The quantifier over those of the variables that the body mentions; one with a quantifier of the same kind.
    static Formula wrap(FormulaKind kind, const std::vector<LiftedVariable>& variables, Formula body) {
        const std::vector<std::uint32_t> slots = free_slots_of(body);
        Formula result;
        result.kind = kind;
        for (const LiftedVariable& variable : variables) {
            if (std::ranges::find(slots, variable.slot) != slots.end()) {
                result.variables.push_back(variable);
            }
        }
        if (result.variables.empty()) {
            return body;
        }
        if (body.kind == kind) {
            std::ranges::copy(body.variables, std::back_inserter(result.variables));
            Formula inner = std::move(body.operands.front());
            body = std::move(inner);
        }
        result.operands.push_back(std::move(body));
        return result;
    }

    const Knowledge& knowledge_;
};

}  // namespace

Formula normal_form(const Knowledge& knowledge, const Formula& formula) {
    return Normaliser(knowledge).run(formula, false);
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
    const auto outside = static_cast<std::ptrdiff_t>(slots.size());
    for (const Term term : formula.terms) {
        if (term >= 0) {
            slots.push_back(static_cast<std::uint32_t>(term));
        }
    }
    for (const Formula& operand : formula.operands) {
        free_slots(operand, slots);
    }
    for (const LiftedVariable& variable : formula.variables) {
        slots.erase(std::remove(slots.begin() + outside, slots.end(), variable.slot), slots.end());
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

}  // namespace relax::grounding
