"""Terms: objects and typed variables, and the formulas that speak of terms alone."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from statehtn.errors import UsageError
from statehtn.model import Equals, Exists, Formula, Parameter
from statehtn.model.formula import Combinable


@dataclass(frozen=True, slots=True)
class Object:
    """An object of a problem or a constant of a domain, with its type; `Type.objects` makes it."""

    name: str
    type: str

    def __str__(self) -> str:
        return self.name


Term = Parameter | Object | str
"""A variable (as `Type.variables` makes it), an object, or the name of an object that is declared."""


def name_of(term: Term) -> str:
    """Return the name of a variable or object; variables keep their question mark."""
    return term if isinstance(term, str) else term.name


def equal(left: Term, right: Term) -> Equals:
    """Return the formula that two terms name the same object; `~equal(a, b)` that they do not.

    (`a == b` compares the Python objects.)

    Args:
        left: a variable, an object or the name of an object.
        right: likewise.

    Raises:
        UsageError: one is none of these.
    """
    for term in (left, right):
        if not isinstance(term, Parameter | Object | str):
            raise UsageError(f"expected a variable or an object, found {term!r}")
    return Equals(name_of(left), name_of(right))


def exists(variables: Iterable[Parameter], body: Combinable) -> Exists:
    """Return the formula that the body holds for some objects of the variables' types."""
    return Exists(checked_variables(variables), checked_formula(body, "the body of 'exists'"))


def checked_formula(formula: object, what: str) -> Formula:
    """Return a formula.

    Args:
        what: what the formula is for, for the message.

    Raises:
        UsageError: it is none; the bool that `not f` or `a == b` gives, say.
    """
    if not isinstance(formula, Combinable):
        raise UsageError(
            f"{what} must be a formula, found {formula!r}; "
            f"formulas are combined by &, | and ~, and terms compared by equal()"
        )
    return formula  # type: ignore[return-value]


def checked_variables(variables: Iterable[Parameter]) -> tuple[Parameter, ...]:
    """Return variables of different names.

    Raises:
        UsageError: they are no variables, or one stands twice.
    """
    if isinstance(variables, Parameter):
        variables = (variables,)
    if not isinstance(variables, Iterable):
        raise UsageError(f"expected variables such as Type.variables() makes, found {variables!r}")
    found = tuple(variables)
    for variable in found:
        if not isinstance(variable, Parameter):
            raise UsageError(f"expected a variable such as Type.variables() makes, found {variable!r}")
    names = [variable.name.lower() for variable in found]
    for variable in found:
        if names.count(variable.name.lower()) > 1:
            raise UsageError(f"variable '{variable.name}' stands twice in one list (case does not matter)")
    return found
