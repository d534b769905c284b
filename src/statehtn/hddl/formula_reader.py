"""Formulas: preconditions, conditions, goals, and the constraints of task networks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.expressions import Group, Node, Word, consumed, describe
from statehtn.hddl.typed_lists import declared_types, read_parameters, typed_list
from statehtn.hddl.vocabulary import Scope, Vocabulary, scope_of
from statehtn.model import TRUE, And, Atom, Equals, Exists, Forall, Formula, Not, OfType, Or
from statehtn.model.hidden import ONLY_COSTS

SORT = frozenset({"sortof", "sort", "typeof"})
NUMERIC = frozenset({"<", "<=", ">", ">="})
TEMPORAL = frozenset(
    {"preference", "always", "sometime", "within", "at-most-once", "sometime-after", "sometime-before", "hold-after"}
)


@dataclass(frozen=True, slots=True)
class FormulaReader:
    """Reads formulas over a vocabulary.

    A constraint is a formula without facts and quantifiers; only the condition of a cost may read what is hidden.
    """

    vocabulary: Vocabulary
    reporter: Reporter
    is_constraint: bool = False
    may_read_hidden: bool = False

    def read(self, node: Node, scope: Scope) -> Formula:
        """Return the formula of a node; `()` is true.

        Args:
            scope: the variables that are declared around it.

        Raises:
            InputError: a name is unknown, or an argument wrong.
            UnsupportedError: it compares numbers or states preferences.
        """
        if isinstance(node, Word):
            raise self.reporter.error(f"expected a formula in parentheses, found {describe(node)}", node)
        if not node.items:
            return TRUE
        if not node.head:
            raise self.reporter.error(
                f"expected a predicate or a word such as 'and', found {describe(node.items[0])}", node
            )
        reader = _READERS.get(node.head)
        if reader is not None:
            return reader(self, node, scope)
        if self.is_constraint:
            return self._sort_constraint(node, scope)
        return self._atom(node, scope)

    def _and(self, node: Group, scope: Scope) -> Formula:
        return And(tuple([self.read(item, scope) for item in consumed(node)]))

    def _or(self, node: Group, scope: Scope) -> Formula:
        return Or(tuple(self.read(item, scope) for item in node.items[1:]))

    def _not(self, node: Group, scope: Scope) -> Formula:
        (operand,) = self._operands(node, 1)
        return Not(self.read(operand, scope))

    def _imply(self, node: Group, scope: Scope) -> Formula:
        premise, conclusion = self._operands(node, 2)
        return Or((Not(self.read(premise, scope)), self.read(conclusion, scope)))

    def _quantifier(self, node: Group, scope: Scope) -> Formula:
        if self.is_constraint:
            raise self.reporter.error(f"expected a constraint on variables, found {describe(node)}", node)
        declared, body = self._operands(node, 2)
        if isinstance(declared, Word):
            raise self.reporter.error(f"expected variables in parentheses, found {describe(declared)}", declared)
        parameters = read_parameters(declared.items, self.vocabulary, self.reporter)
        inner = self.read(body, {**scope, **scope_of(parameters)})
        return Forall(parameters, inner) if node.head == "forall" else Exists(parameters, inner)

    def _equals(self, node: Group, scope: Scope) -> Formula:
        left, right = self._operands(node, 2)
        if isinstance(left, Group) or isinstance(right, Group):
            raise self.reporter.unsupported("comparing the values of functions is not supported", node)
        return Equals(
            self.vocabulary.term(left, scope, self.reporter), self.vocabulary.term(right, scope, self.reporter)
        )

    def _atom(self, node: Group, scope: Scope) -> Formula:
        signature = self.vocabulary.predicate(node.name)
        if signature is not None:
            if not self.may_read_hidden and signature.name in self.vocabulary.hidden:
                raise self.reporter.unsupported(f"this reads a fact of '{signature.name}'; {ONLY_COSTS}", node)
            terms = self.vocabulary.terms("predicate", signature, node, node.items[1:], scope, self.reporter)
            return Atom(signature.name, terms)
        if node.head in SORT:
            return self._sort_constraint(node, scope)
        if node.head in NUMERIC:
            raise self.reporter.unsupported("comparing numbers in a condition is not supported", node)
        if node.head in TEMPORAL:
            raise self.reporter.unsupported(
                f"preferences and trajectory constraints ('{node.head}') are not supported", node
            )
        raise self.reporter.error(unknown("predicate", node.name, self.vocabulary.predicates), node.items[0])

    def _sort_constraint(self, node: Group, scope: Scope) -> Formula:
        """Read `(sortof ?x - t)`."""
        if node.head not in SORT:
            raise self.reporter.error(
                f"expected a constraint ('=', 'sortof', 'not', 'and', 'or'), found {describe(node)}",
                node,
            )
        declared = typed_list(node.items[1:], self.reporter)
        if len(declared) != 1 or not declared[0][1]:
            raise self.reporter.error(f"expected '({node.head} ?x - <type>)', one variable and its type", node)
        ((term, kinds),) = declared
        types = declared_types(kinds, self.vocabulary, self.reporter)
        return OfType(self.vocabulary.term(term, scope, self.reporter), types)

    def _operands(self, node: Group, count: int) -> list[Node]:
        if len(node.items) != count + 1:
            expected = f"{count} operand{'s' if count > 1 else ''} of '{node.head}'"
            raise self.reporter.error(f"expected {expected}, found {len(node.items) - 1}", node)
        return node.items[1:]


_READERS: dict[str, Callable[[FormulaReader, Group, Scope], Formula]] = {
    "and": FormulaReader._and,
    "or": FormulaReader._or,
    "not": FormulaReader._not,
    "imply": FormulaReader._imply,
    "forall": FormulaReader._quantifier,
    "exists": FormulaReader._quantifier,
    "=": FormulaReader._equals,
}
