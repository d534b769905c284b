"""The heuristics of the compiled core: what is known of each, and each on its own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.pricing import price
from statehtn.core.scale import Scale
from statehtn.risk import Utility


@dataclass(frozen=True, slots=True)
class HeuristicInfo:
    """What is known of a heuristic.

    Args:
        admissible: it never estimates more than is still to pay.
        consistent: along a step it falls by at most the step's cost.
        safe: what it calls a dead end is one.
        description: what it does, and where it comes from.
    """

    admissible: bool
    consistent: bool
    safe: bool
    description: str


HEURISTICS: Mapping[str, HeuristicInfo] = MappingProxyType(
    {one.name: HeuristicInfo(one.admissible, one.consistent, one.safe, one.description) for one in _relax.heuristics()}
)
"""The heuristics by name: whether each is admissible, consistent and safe, and a line about it with its source."""

ADMISSIBLE = tuple(name for name, info in HEURISTICS.items() if info.admissible)
"""Those that never estimate too much: what a search proves rests on that."""

PORTFOLIO = "auto"
"""The name of no heuristic, but of three searches in turn, which share what they prove: with `tdg`, with `lmcut`, and
with `potential-hmax`, `potential` and `lmcut` one after the other."""

GREEDY = "ff"
"""The heuristic of greedy search where none is named."""


class HeuristicEvaluator:
    """A heuristic on its own, for states and networks of the caller's choice."""

    def __init__(self, grounding: Grounding, utility: Utility, heuristic: str) -> None:
        problem = price(grounding, utility)
        self._scale = Scale.first(problem.bounds())
        self._evaluator = _relax.Evaluator(problem.on(self._scale).handle, heuristic)

    def __call__(
        self, state: Iterable[int], tasks: Iterable[int], ordering: Iterable[tuple[int, int]] | None = None
    ) -> float | None:
        """Estimate the cost still to come, rounded down; None for a dead end.

        Args:
            state: the facts that hold, numbered as in `Grounding.to_model()`.
            tasks: the tasks of the network, with repetitions, numbered likewise.
            ordering: pairs of places in `tasks`, the earlier one first, transitively closed; None where the order is
                not known. If the problem is totally ordered, the tasks should stand in their order: as in a search.
        """
        units = self._evaluator.evaluate(list(state), list(tasks), None if ordering is None else list(ordering))
        return None if units is None else self._scale.cost(units)
