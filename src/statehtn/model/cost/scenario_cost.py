"""Costs that hang together: each has a law of its own in every scenario, and a scenario is common to all of a plan."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from statehtn.errors import UsageError
from statehtn.expected import did_you_mean, shown
from statehtn.model.chance import Scenario
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.mixture import Mixed, mixture_of
from statehtn.model.cost.sum import CostSum, total_cost

if TYPE_CHECKING:
    from numpy import float64
    from numpy.random import Generator
    from numpy.typing import NDArray


@dataclass(frozen=True, repr=False)
class ScenarioCost(Mixed):
    """A cost that depends on what is hidden: a law given each scenario, and the mixture of them all.

    Whatever a law is asked, it answers for the mixture. Costs of one plan have the same scenarios: given one of them
    they are independent, and over all of them they are not (`sum_of`, `total_of`).

    Args:
        scenarios: of the problem.
        laws: one for each scenario.
    """

    scenarios: tuple[Scenario, ...]
    laws: tuple[CostLaw, ...]

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        return hash(self.laws)

    def given(self, scenario: Scenario | str | int) -> CostLaw:
        """Return the law given a scenario: itself, its name, or its number from 0.

        Raises:
            UsageError: there is no such scenario.
        """
        if isinstance(scenario, int) and 0 <= scenario < len(self.laws):
            return self.laws[scenario]
        name = str(scenario)
        for known, law in zip(self.scenarios, self.laws, strict=True):
            if known.name == name:
                return law
        names = [known.name for known in self.scenarios]
        raise UsageError(f"there is no scenario {shown(scenario)}{did_you_mean(name, names)}")

    @cached_property
    def weights(self) -> tuple[float, ...]:
        """The probability of each scenario."""
        return tuple(scenario.probability for scenario in self.scenarios)

    def __str__(self) -> str:
        if self.mixture is None:
            return f"a law for each of {len(self.laws)} scenarios, from {self.least:g} to {self.most:g}"
        return str(self.mixture)


def by_scenario(scenarios: tuple[Scenario, ...], laws: Sequence[CostLaw]) -> CostLaw:
    """Return the cost that has a law in each scenario: the law itself where it is the same in all of them."""
    first = laws[0]
    return first if all(law is first or law == first for law in laws) else ScenarioCost(scenarios, tuple(laws))


def as_if_independent(laws: Iterable[CostLaw]) -> tuple[CostLaw, ...] | None:
    """Return the laws over all scenarios as if they had none in common; None where one has no list of outcomes."""
    found = [law.mixture if isinstance(law, ScenarioCost) else law for law in laws]
    return None if None in found else tuple(law for law in found if law is not None)


def sum_of(laws: Sequence[CostLaw]) -> CostLaw:
    """Return the sum of costs that are independent given each scenario; of one cost that cost itself."""
    if len(laws) == 1:
        return laws[0]
    return _in_each_scenario(laws, lambda given: CostSum(tuple(given)))


def mixed(weights: Sequence[float], laws: Sequence[CostLaw]) -> CostLaw:
    """Return the law of a cost that has one of several laws by chance, whatever the scenario; see `mixture_of`."""
    return _in_each_scenario(laws, lambda given: mixture_of(weights, given))


def total_of(laws: Iterable[CostLaw]) -> CostLaw:
    """Return the law of the sum of costs that are independent given each scenario; see `total_cost`.

    Where costs depend on scenarios it is the mixture of the totals given each of them, a `CostDistribution` if all are
    lists of outcomes.
    """
    total = total_by_scenario(laws)
    return total.mixture or total if isinstance(total, ScenarioCost) else total


def total_by_scenario(laws: Iterable[CostLaw]) -> CostLaw:
    """Return the law of the sum, as `total_of`, with its law given each scenario where it has several."""
    return _in_each_scenario(list(laws), total_cost)


def _in_each_scenario(laws: Sequence[CostLaw], summed: Callable[[Sequence[CostLaw]], CostLaw]) -> CostLaw:
    """Sum up the laws given each scenario; without costs that depend on scenarios, once."""
    scenarios = next((law.scenarios for law in laws if isinstance(law, ScenarioCost)), None)
    if scenarios is None:
        return summed(laws)
    return ScenarioCost(
        scenarios,
        tuple(
            summed([law.laws[index] if isinstance(law, ScenarioCost) else law for law in laws])
            for index in range(len(scenarios))
        ),
    )


def sampled_total(laws: Sequence[CostLaw], runs: int, generator: Generator) -> NDArray[float64]:
    """Draw so many sums of costs that are independent given each scenario."""
    import numpy

    total = _in_each_scenario(laws, lambda given: CostSum(tuple(given)))
    return total.sample(runs, generator) if laws else numpy.zeros(runs)
