"""Python callables as costs: the external cost functions of the paper."""

from __future__ import annotations

from dataclasses import dataclass, field
from inspect import signature
from typing import Any

from statehtn.errors import InputError, StateHtnError, UsageError
from statehtn.model import Parameter
from statehtn.model.cost.blocks import ExternalCost


@dataclass(frozen=True, slots=True)
class ExternalFunction:
    """A callable that gives the cost of an action's instances, called once for each tuple of arguments.

    The answers are kept, so that search, validation and pricing see the same cost, also where the callable asks a
    service whose answers change. Two are equal if action and callable are the same.
    """

    action: str
    function: ExternalCost
    _answers: dict[tuple[str, ...], Any] = field(default_factory=dict, compare=False, repr=False)

    def __call__(self, *arguments: str) -> Any:
        """Return what the callable says for the names of an action's objects.

        Raises:
            InputError: the callable raised an exception; names it, the action and its arguments.
        """
        if arguments not in self._answers:
            try:
                self._answers[arguments] = self.function(*arguments)
            except Exception as error:
                told = error.message if isinstance(error, StateHtnError) else f"{type(error).__name__}: {error}"
                raise InputError(
                    f"the external cost of ({' '.join((self.action, *arguments))}): "
                    f"{name_of(self.function)} failed with {told}"
                ) from error
        return self._answers[arguments]


def external(action: str, parameters: tuple[Parameter, ...], function: ExternalCost) -> ExternalFunction:
    """Return a callable as the cost of an action with these parameters.

    Raises:
        UsageError: it cannot be called with that many arguments.
    """
    try:
        expected = signature(function)
    except (TypeError, ValueError):  # some built-in functions do not tell
        return ExternalFunction(action, function)
    try:
        expected.bind(*(parameter.name for parameter in parameters))
    except TypeError:
        names = " ".join(parameter.name for parameter in parameters)
        given = f"its arguments ({names})" if names else "no arguments"
        raise UsageError(
            f"the cost of action '{action}' is called with {given}, but {name_of(function)} takes {expected}"
        ) from None
    return ExternalFunction(action, function)


def name_of(function: ExternalCost) -> str:
    """Return the name of a callable for messages."""
    name = getattr(function, "__name__", type(function).__name__)
    return "the lambda function" if name == "<lambda>" else f"'{name}'"
