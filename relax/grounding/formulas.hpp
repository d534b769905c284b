#ifndef RELAX_GROUNDING_FORMULAS_HPP
#define RELAX_GROUNDING_FORMULAS_HPP

#include <cstdint>
#include <vector>

#include "facts.hpp"

namespace relax::grounding {

// The formula with negation in front of atoms, equalities and domains only, and with quantifiers as far inside as they
// go: a quantifier stands over nothing that does not mention its variables, and where two parts share no variables,
// each has a quantifier of its own. Quantifiers that stand beside each other may share slots.
//
// Sound: the two rules Q x (A op B(x)) = A op Q x B(x) hold where there is an object for x, and elsewhere `exists` is
// false and `forall` true; `exists` distributes over `or` and `forall` over `and`; and for parts A(x), B(y) without a
// common variable, exists x y (A(x) and B(y)) = (exists x A(x)) and (exists y B(y)), dually for `forall`.
Formula normal_form(const Knowledge& knowledge, const Formula& formula);

// Append the formula's top-level conjuncts; expects normal form.
void split_conjunction(const Formula& formula, std::vector<Formula>& conjuncts);

inline bool is_true(const Formula& formula) { return formula.kind == FormulaKind::And && formula.operands.empty(); }

// Append the slots of the formula's variables that none of its quantifiers binds, with repetitions.
void free_slots(const Formula& formula, std::vector<std::uint32_t>& slots);

// Append the growing predicates that stand without negation in it: those that its relaxed truth waits for.
void awaited_predicates(const Knowledge& knowledge, const Formula& formula, std::vector<std::uint32_t>& predicates);

}  // namespace relax::grounding

#endif
