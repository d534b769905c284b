"""What the model checker Storm says of models in the PRISM language; only where it is installed (extra `check`)."""

from __future__ import annotations

import itertools
import math
import tempfile
from collections.abc import Iterable
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

import pytest

from tests.exact import decimal_of

stormpy: Any = pytest.importorskip("stormpy", reason="Storm is not installed (pip install 'statehtn[check]')")


class StormModel:
    """A model that Storm has read; all answers are fractions, or infinite.

    Args:
        lines: the model in the PRISM language.
        exact: whether Storm computes with fractions, instead of floats whose errors it bounds.
    """

    def __init__(self, lines: Iterable[str], exact: bool = True) -> None:
        self.exact = exact
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "model.prism")
            path.write_text("\n".join(lines))
            self.program = stormpy.parse_prism_program(path)
        build = stormpy.build_model[stormpy.Rational] if exact else stormpy.build_model
        self.model = build(self.program)  # for all properties
        self.names = (f"K{number}" for number in itertools.count())  # Storm takes no name twice

    def value(self, formula: str) -> Fraction | float:
        """The value of a property in the initial state."""
        wanted = stormpy.parse_property(formula, self.program)
        environment = stormpy.environments.exact() if self.exact else stormpy.environments.sound()
        found = stormpy.model_checking(self.model, wanted, only_initial_states=True, environment=environment)
        text = str(found.get_value(self.model.initial_states[0]))
        return math.inf if "inf" in text else Fraction(text)

    @cached_property
    def success_probability(self) -> Fraction | float:
        """The largest probability of being done."""
        return self.value('Pmax=? [F "done"]')

    @cached_property
    def expected_cost(self) -> Fraction | float:
        """The least expected cost in units, of those that are done with probability 1; infinite where there is none."""
        return self.value('R{"cost"}min=? [F "done"]')

    def within(self, units: int) -> Fraction | float:
        """The largest probability of being done at a cost of at most so many units."""
        return self.value(f'Pmax=? [F{{"cost"}}<={units} "done"]')

    def quantile(self, level: Fraction) -> Fraction | float:
        """The least number of units within which the probability of being done is above this; it must be attainable."""
        name = next(self.names)
        return self.value(f'quantile(min {name}, Pmax>{decimal_text(level)} [F{{"cost"}}<={name} "done"])')


def decimal_text(number: Fraction) -> str:
    return f"{decimal_of(number):f}"
