"""Methods of a session for one problem as functions of a problem."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Concatenate, ParamSpec, Protocol, TypeVar

from statehtn.model.problem import Problem

P = ParamSpec("P")
R_co = TypeVar("R_co", covariant=True)
S = TypeVar("S")


class OneShot(Protocol[P, R_co]):
    """A method of a session as a function of a problem."""

    def __call__(self, problem: Problem, *args: P.args, **kwargs: P.kwargs) -> R_co:
        """Call the method of a session for the problem."""


def one_shot(session: Callable[[Problem], S], method: Callable[Concatenate[S, P], R_co]) -> OneShot[P, R_co]:
    """Return a method of a session as a function of a problem: a session of one call."""

    @wraps(method)
    def call(problem: Problem, *args: P.args, **kwargs: P.kwargs) -> R_co:
        return method(session(problem), *args, **kwargs)

    own = inspect.signature(method)
    first = inspect.Parameter("problem", inspect.Parameter.POSITIONAL_OR_KEYWORD, annotation="Problem")
    call.__signature__ = own.replace(parameters=[first, *list(own.parameters.values())[1:]])  # type: ignore[attr-defined]
    call.__qualname__ = method.__name__
    return call
