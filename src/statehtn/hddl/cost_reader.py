"""Costs inside effects: `increase` of the total cost, `probabilistic` blocks of them, and the expressions in both."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from statehtn.expected import shown_number
from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.expressions import Group, Node, Word, describe
from statehtn.hddl.vocabulary import Scope, Vocabulary
from statehtn.model import Arithmetic, Expression, FunctionTerm, Number
from statehtn.model.cost.blocks import PROBABILITY_TOLERANCE
from statehtn.model.cost.expressions import constant_value

TOTAL_COST = "total-cost"
LEAST_NUMBER, MOST_NUMBER = Fraction(math.ulp(0.0)), Fraction(sys.float_info.max)  # above 0, in floating point
Branches = tuple[tuple[Expression, Expression], ...]

_NUMERIC = frozenset({"decrease", "assign", "scale-up", "scale-down"})
_AROUND = {
    "when": "conditions stand around: (when <condition> (probabilistic ...))",
    "forall": "quantifiers stand around: (forall (<variables>) (probabilistic ...))",
    "probabilistic": "write the products of the probabilities in one block",
}
"""What to write instead of what is not read inside a branch."""

_NUMBER = re.compile(
    r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)(e[+-]?(?P<exponent>[0-9]+))?|[+-]?[0-9]+/0*[1-9][0-9]*",
    re.ASCII | re.IGNORECASE,
)
MAX_DIGITS = 2000


def read_number(text: str) -> Fraction | None:
    """Return the exact value of `3`, `-0.5`, `.5`, `1e-3` or `1/3`; None for anything else.

    Numbers of more than 2000 characters, exponents of more than three digits and what is out of the range of
    floating-point numbers are none.
    """
    match = _NUMBER.fullmatch(text)
    if match is None or len(text) > MAX_DIGITS or len(match["exponent"] or "") > 3:
        return None
    value = Fraction(text)
    return value if not value or LEAST_NUMBER <= abs(value) <= MOST_NUMBER else None


def not_read(expected: str, word: Word) -> str:
    """Return the message that a word is no number where one, or something else, is `expected`."""
    if _NUMBER.fullmatch(word.text):
        return (
            f"the number {describe(word)} is out of range: its size must be 0, or from 5e-324 to 1.79e308, and it must "
            f"have at most {MAX_DIGITS} characters, and an exponent of three digits"
        )
    return f"expected {expected}, found {describe(word)}"


@dataclass(frozen=True, slots=True)
class CostReader:
    """Reads costs over a vocabulary."""

    vocabulary: Vocabulary
    reporter: Reporter

    def increase(self, node: Group, scope: Scope) -> Expression:
        """Return the expression of `(increase (total-cost) <expression>)`.

        Raises:
            InputError: it is malformed, or a negative constant.
            UnsupportedError: it increases another function.
        """
        if len(node.items) != 3:
            raise self.reporter.error("expected '(increase (total-cost) <expression>)'", node)
        target, amount = node.items[1:]
        name = target.head if isinstance(target, Group) else target.lower
        if name != TOTAL_COST:
            raise self.reporter.unsupported(
                f"only (total-cost) can be increased, found {describe(target)}; actions cannot change other numbers",
                target,
            )
        if isinstance(target, Word):
            self.reporter.warn("'total-cost' is a function and belongs in parentheses: (total-cost)", target)
        elif len(target.items) != 1:
            raise self.reporter.error("'total-cost' takes no arguments", target)
        cost = self.expression(amount, scope)
        value = constant_value(cost)
        if value is not None and value < 0:
            raise self.reporter.error(f"a cost must not be negative, found {shown_number(value)}", amount)
        return cost

    def probabilistic(self, node: Group, scope: Scope) -> Branches:
        """Return the branches of `(probabilistic p1 e1 p2 e2 ...)`, each effect a cost or nothing.

        Raises:
            InputError: probabilities that are constant are negative or sum to more than 1.
            UnsupportedError: an effect does more than to increase the total cost.
        """
        pairs = self.chances(node, scope)
        branches = tuple((probability, self._outcome(effect, scope)) for probability, effect in pairs)
        self.check_sum(pairs, node, "it costs 0")
        return branches

    def chances(self, node: Group, scope: Scope) -> list[tuple[Expression, Node]]:
        """Return the pairs of a probability and an effect of `(probabilistic p1 e1 p2 e2 ...)`.

        Raises:
            InputError: a constant probability is negative.
        """
        nodes = node.items[1:]
        if not nodes or len(nodes) % 2:
            raise self.reporter.error(
                f"expected pairs of a probability and an effect after 'probabilistic', found {len(nodes)} items", node
            )
        pairs = []
        for probability_node, effect in zip(nodes[::2], nodes[1::2], strict=True):
            probability = self.expression(probability_node, scope)
            value = constant_value(probability)
            if value is not None and value < 0:
                raise self.reporter.error(
                    f"a probability must not be negative, found {shown_number(value)}", probability_node
                )
            pairs.append((probability, effect))
        return pairs

    def expression(self, node: Node, scope: Scope) -> Expression:
        """Return a number, a function of the parameters, or a sum, difference or product of expressions."""
        if isinstance(node, Word):
            value = read_number(node.text)
            if value is None:
                hint = "; functions stand in parentheses" if self.vocabulary.function(node.text) else ""
                raise self.reporter.error(not_read("a number or a function in parentheses", node) + hint, node)
            return Number(value)
        signature = self.vocabulary.function(node.name)
        if signature is not None:
            terms = self.vocabulary.terms("function", signature, node, node.items[1:], scope, self.reporter)
            return FunctionTerm(signature.name, terms)
        operands = node.items[1:]
        if node.head in ("+", "-", "*"):
            if not operands:
                raise self.reporter.error(f"'{node.head}' needs an operand", node)
            return Arithmetic(node.head, tuple(self.expression(operand, scope) for operand in operands))
        if node.head == "/":
            raise self.reporter.unsupported("division is not supported in costs; write a number or a function", node)
        if node.head == TOTAL_COST:
            raise self.reporter.unsupported("a cost cannot depend on the total cost so far", node)
        if not node.head:
            raise self.reporter.error(f"expected a number, a function or + - *, found {describe(node)}", node)
        raise self.reporter.error(unknown("function", node.name, self.vocabulary.functions), node.items[0])

    def _outcome(self, node: Node, scope: Scope) -> Expression:
        """Return the cost of one branch; several increases add up, no effect costs 0."""
        if isinstance(node, Word):
            raise self.reporter.error(
                f"expected an effect such as '(increase (total-cost) 2)', found {describe(node)}", node
            )
        if not node.items:
            return Number(Fraction(0))
        if node.head == "increase":
            return self.increase(node, scope)
        if node.head == "and":
            costs = tuple(self._outcome(item, scope) for item in node.items[1:])
            return costs[0] if len(costs) == 1 else Arithmetic("+", costs) if costs else Number(Fraction(0))
        if hint := _AROUND.get(node.head):
            raise self.reporter.unsupported(
                f"a branch of 'probabilistic' that changes no facts can only increase (total-cost), found "
                f"{describe(node)}; {hint}",
                node,
            )
        raise refusal(node, self.vocabulary, self.reporter)

    def check_sum(self, pairs: Iterable[tuple[Expression, Node]], node: Group, rest: str) -> None:
        """Refuse constant probabilities that sum to more than 1; warn of a sum that is less.

        Args:
            pairs: as `chances` returns them.
            node: the block.
            rest: what happens with the rest of probability 1, for the warning.

        Raises:
            InputError: they sum to more than 1.
        """
        values = [constant_value(probability) for probability, _ in pairs]
        total = sum((value for value in values if value is not None), Fraction(0))
        if total > 1 + PROBABILITY_TOLERANCE:  # those that are not constant are at least 0
            raise self.reporter.error(
                f"the probabilities of this block sum to {shown_number(total)}, more than 1", node
            )
        if None not in values and total < 1 - PROBABILITY_TOLERANCE:
            self.reporter.warn(
                f"the probabilities of this block sum to {shown_number(total)}; with the rest {rest}", node
            )


def refusal(node: Group, vocabulary: Vocabulary, reporter: Reporter) -> Exception:
    """Return the error that something is no effect."""
    if not node.head:
        return reporter.error(f"expected an effect, found {describe(node.items[0])}", node)
    if node.head in _NUMERIC:
        return reporter.unsupported(
            f"numeric effects ('{node.head}') are not supported, only costs by 'increase'", node
        )
    if node.head == "oneof":
        return reporter.unsupported(
            "non-deterministic effects ('oneof') are not supported; 'probabilistic' states outcomes", node
        )
    if node.head in ("or", "imply", "exists", "="):
        return reporter.error(f"'{node.head}' cannot be an effect", node)
    return reporter.error(unknown("predicate", node.name, vocabulary.predicates), node.items[0])
