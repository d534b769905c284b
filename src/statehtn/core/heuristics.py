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
        kind: its name in the core.
        admissible: it never estimates more than is still to pay.
        consistent: along a step it falls by at most the step's cost.
        safe: what it calls a dead end is one.
        description: what it does, and where it comes from.
    """

    kind: _relax.HeuristicKind
    admissible: bool
    consistent: bool
    safe: bool
    description: str


HEURISTICS: Mapping[str, HeuristicInfo] = MappingProxyType(
    {
        "blind": HeuristicInfo(_relax.HeuristicKind.Blind, True, True, True, "always 0: uniform-cost search"),
        "tdg": HeuristicInfo(
            _relax.HeuristicKind.Tdg,
            True,
            True,
            True,
            "least cost of any decomposition, states ignored (the paper's Algorithms 1 and 2)",
        ),
        "hmax": HeuristicInfo(
            _relax.HeuristicKind.HMax,
            True,
            True,
            True,
            "max heuristic on the relaxed model (the paper's Algorithm 5; Bonet and Geffner 2001)",
        ),
        "lmcut": HeuristicInfo(
            _relax.HeuristicKind.LmCut,
            True,
            False,
            True,
            "landmark cuts on the relaxed model (the paper's Algorithm 5; Helmert and Domshlak 2009)",
        ),
        "potential": HeuristicInfo(
            _relax.HeuristicKind.Potential,
            True,
            False,
            True,
            "decomposition-graph bound, plus landmark cuts on what methods cost beyond it, in the hierarchy's order",
        ),
        "potential-hmax": HeuristicInfo(
            _relax.HeuristicKind.PotentialHMax,
            True,
            False,
            True,
            "the same with the max heuristic instead of landmark cuts: a little less, in a fraction of the time",
        ),
        "add": HeuristicInfo(
            _relax.HeuristicKind.Add,
            False,
            False,
            True,
            "additive heuristic on the relaxed model, for greedy search (Bonet and Geffner 2001)",
        ),
        "ff": HeuristicInfo(
            _relax.HeuristicKind.Ff,
            False,
            False,
            True,
            "relaxed plan on the relaxed model, for greedy search (Hoffmann and Nebel 2001)",
        ),
    }
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
        self._evaluator = _relax.Evaluator(problem.on(self._scale).handle, HEURISTICS[heuristic].kind)

    @property
    def model_bytes(self) -> int:
        """The size of the relaxed model that an evaluation reads at most; 0 for a heuristic without one."""
        return self._evaluator.model_bytes

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
