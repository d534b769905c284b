"""Expressions of unified-planning (UP) as formulas and cost expressions.

UP has fluents with objects as values; here such a fluent is a predicate with the value as its last argument, true of
exactly one value at a time. Where its value is an argument, the formula says that there is an object that is the value.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain
from typing import Any

from statehtn.errors import UnsupportedError
from statehtn.hddl.spelling import Spellings
from statehtn.interop.names import Vocabulary, our_name
from statehtn.model import (
    TRUE,
    And,
    Arithmetic,
    Atom,
    Equals,
    Exists,
    Expression,
    Forall,
    Formula,
    FunctionTerm,
    Not,
    Number,
    Or,
    Parameter,
)

FALSE = Or(())
Typed = Any
"""A parameter or a variable of UP: it has a name and a type."""


def conjunction(formulas: Iterable[Formula]) -> Formula:
    """Return one formula that all of them hold."""
    found = tuple(formula for formula in formulas if formula != TRUE)
    return found[0] if len(found) == 1 else And(found)


def our_type(kind: Any, vocabulary: Vocabulary) -> str:
    """Return the type of objects that a type of UP stands for.

    Raises:
        UnsupportedError: it is a type of numbers or truth values.
    """
    if not kind.is_user_type():
        raise UnsupportedError(f"parameters are objects, found one of type '{kind}'")
    return vocabulary.our_type(kind)


@dataclass(frozen=True)
class Scope:
    """The variables that an expression may use, by kind ('parameter' or 'variable') and UP's name.

    The objects that expressions name are added to `named`.
    """

    vocabulary: Vocabulary
    variables: Mapping[tuple[str, str], Parameter]
    named: set[str]

    @staticmethod
    def of(vocabulary: Vocabulary, parameters: Iterable[Typed] = (), named: set[str] | None = None) -> Scope:
        """Return the scope of parameters."""
        return Scope(vocabulary, {}, set() if named is None else named).extended("parameter", parameters)

    def extended(self, kind: str, added: Iterable[Typed]) -> Scope:
        """Return the scope with more variables, whose names are new."""
        variables = dict(self.variables)
        for typed in added:
            variables[kind, typed.name] = self._fresh(variables.values(), typed.name, typed.type)
        return replace(self, variables=variables)

    def parameters(self, kind: str, wanted: Iterable[Typed]) -> tuple[Parameter, ...]:
        """Return the variables that stand for UP's."""
        return tuple(self.variables[kind, typed.name] for typed in wanted)

    def fresh(self, used: Iterable[Parameter], name: str, kind: Any) -> Parameter:
        """Return a new variable of a type of UP's, other than those in use."""
        return self._fresh(chain(self.variables.values(), used), name, kind)

    def _fresh(self, used: Iterable[Parameter], name: str, kind: Any) -> Parameter:
        taken = Spellings(parameter.name[1:] for parameter in used)
        return Parameter(f"?{our_name(name, taken)}", (our_type(kind, self.vocabulary),))

    def formula(self, node: Any) -> Formula:
        """Return the formula that an expression of UP is.

        Raises:
            UnsupportedError: it speaks of numbers or times.
        """
        if node.is_bool_constant():
            return TRUE if node.is_true() else FALSE
        if node.is_and():
            return And(tuple(map(self.formula, node.args)))
        if node.is_or():
            return Or(tuple(map(self.formula, node.args)))
        if node.is_not():
            return Not(self.formula(node.arg(0)))
        if node.is_implies():
            return _implies(*map(self.formula, node.args))
        if node.is_iff():
            left, right = map(self.formula, node.args)
            return And((_implies(left, right), _implies(right, left)))
        if node.is_exists() or node.is_forall():
            inner = self.extended("variable", node.variables())
            quantifier = Exists if node.is_exists() else Forall
            return quantifier(inner.parameters("variable", node.variables()), inner.formula(node.arg(0)))
        if node.is_fluent_exp() and node.type.is_bool_type():
            return self.atom(node)
        if node.is_equals() and all(argument.type.is_user_type() for argument in node.args):
            left, right = node.args if not node.arg(1).is_fluent_exp() else reversed(node.args)
            if left.is_fluent_exp():
                return self.with_terms((*left.args, right), lambda terms: Atom(self._fluent(left), terms))
            return self.with_terms((left, right), lambda terms: Equals(*terms))
        raise UnsupportedError(f"a condition may speak of facts and objects, found '{node}'")

    def atom(self, node: Any) -> Formula:
        """Return the fact that a fluent without a value of its own is true of its arguments."""
        return self.with_terms(node.args, lambda terms: Atom(self._fluent(node), terms))

    def with_terms(self, nodes: Iterable[Any], body: Callable[[tuple[str, ...]], Formula]) -> Formula:
        """Return a formula about objects; those that are values of fluents get variables that exist."""
        terms, values, facts = self.terms(nodes)
        formula = body(terms)
        return Exists(values, And((*facts, formula))) if values else formula

    def terms(self, nodes: Iterable[Any]) -> tuple[tuple[str, ...], tuple[Parameter, ...], tuple[Formula, ...]]:
        """Return expressions of UP as terms, with variables for the values of fluents and what defines these."""
        terms: list[str] = []
        values: list[Parameter] = []
        facts: list[Formula] = []
        for node in nodes:
            if node.is_fluent_exp() and node.type.is_user_type():
                taken = {("value", value.name): value for value in values}
                inner, more_values, more_facts = replace(self, variables={**self.variables, **taken}).terms(node.args)
                values += more_values
                facts += more_facts
                values.append(self.fresh(values, "value", node.type))
                facts.append(Atom(self._fluent(node), (*inner, values[-1].name)))
                terms.append(values[-1].name)
            else:
                terms.append(self.term(node))
        return tuple(terms), tuple(values), tuple(facts)

    def term(self, node: Any) -> str:
        """Return the variable or object that an expression of UP is.

        Raises:
            UnsupportedError: it is neither.
        """
        if node.is_object_exp():
            name = self.vocabulary.objects.ours(node.object().name)
            self.named.add(name)
            return name
        if node.is_parameter_exp() and ("parameter", node.parameter().name) in self.variables:
            return self.variables["parameter", node.parameter().name].name
        if node.is_variable_exp() and ("variable", node.variable().name) in self.variables:
            return self.variables["variable", node.variable().name].name
        raise UnsupportedError(f"an argument is a parameter or an object, found '{node}'")

    def _fluent(self, node: Any) -> str:
        return self.vocabulary.fluents.ours(node.fluent().name)

    def cost(self, node: Any) -> Expression:
        """Return the cost expression that a number expression of UP is.

        Raises:
            UnsupportedError: it does more than add, subtract and multiply numbers and fluents of the parameters.
        """
        if node.is_int_constant() or node.is_real_constant():
            return Number(Fraction(node.constant_value()))
        if node.is_fluent_exp() and (node.type.is_int_type() or node.type.is_real_type()):
            return FunctionTerm(self._fluent(node), tuple(map(self.term, node.args)))
        for is_kind, operator in ((node.is_plus, "+"), (node.is_minus, "-"), (node.is_times, "*")):
            if is_kind():
                return Arithmetic(operator, tuple(map(self.cost, node.args)))
        if node.is_div() and (node.arg(1).is_int_constant() or node.arg(1).is_real_constant()):
            divisor = Fraction(node.arg(1).constant_value())
            if divisor != 0:
                return Arithmetic("*", (self.cost(node.arg(0)), Number(1 / divisor)))
        raise UnsupportedError(f"a cost is made of numbers, fluents of the parameters, +, - and *, found '{node}'")


def _implies(left: Formula, right: Formula) -> Formula:
    return Or((Not(left), right))
