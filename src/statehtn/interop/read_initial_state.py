"""Initial states of unified-planning (UP): explicit values, and defaults for all others."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from itertools import product
from typing import Any

from statehtn.errors import UnsupportedError
from statehtn.interop.names import Vocabulary
from statehtn.model import Fact


def read_initial_state(problem: Any, vocabulary: Vocabulary) -> tuple[frozenset[Fact], dict[tuple[str, ...], Fraction]]:
    """Return the facts that are true, and the values of functions; a number without a value has none here either.

    Raises:
        UnsupportedError: a fact is neither true nor false, or a fluent has no object as value.
    """
    explicit: dict[str, dict[tuple[str, ...], Any]] = {}
    for fluent, value in problem.explicit_initial_values.items():
        arguments = tuple(argument.object().name for argument in fluent.args)
        explicit.setdefault(fluent.fluent().name, {})[arguments] = value
    facts: set[Fact] = set()
    values: dict[tuple[str, ...], Fraction] = {}
    for fluent in problem.fluents:
        name = vocabulary.fluents.ours(fluent.name)
        default = problem.fluents_defaults.get(fluent)
        stated = explicit.get(fluent.name, {})
        is_number = fluent.type.is_int_type() or fluent.type.is_real_type()
        if default is None and not is_number and len(stated) < _size(fluent, problem):
            raise UnsupportedError(f"fluent '{fluent.name}' has no initial value for some objects; give it a default")
        if default is not None and not default.is_false():
            stated = dict.fromkeys(_instances(fluent, problem), default) | stated
        for arguments, value in stated.items():
            fact = (name, *map(vocabulary.objects.ours, arguments))
            if is_number:
                values[fact] = Fraction(value.constant_value())
            elif value.is_object_exp():
                facts.add((*fact, vocabulary.objects.ours(value.object().name)))
            elif value.is_true():
                facts.add(fact)
            elif not value.is_false():
                raise UnsupportedError(f"the initial value of '{fluent.name}' is no constant, found '{value}'")
    return frozenset(facts), values


def _columns(fluent: Any, problem: Any) -> list[list[str]]:
    return [[one.name for one in problem.objects(parameter.type)] for parameter in fluent.signature]


def _size(fluent: Any, problem: Any) -> int:
    return math.prod(map(len, _columns(fluent, problem)))


def _instances(fluent: Any, problem: Any) -> Iterator[tuple[str, ...]]:
    return product(*_columns(fluent, problem))
