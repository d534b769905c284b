"""A ground problem in each of its scenarios, where costs hang together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from statehtn.core.grounding import Grounding
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.scenario_cost import ScenarioCost


@dataclass(frozen=True, slots=True)
class GivenScenario:
    """Scenarios between which no cost distinguishes.

    Args:
        probability: of all of them together.
        grounding: the ground problem with the laws that costs have in them: there they are independent.
    """

    probability: float
    grounding: Grounding


def given_scenarios(grounding: Grounding) -> list[GivenScenario]:
    """Return a ground problem in each of its scenarios; those in which all costs have the same laws are one."""
    dependent = {id(law): law for law in (*grounding.laws, *grounding.part_laws) if isinstance(law, ScenarioCost)}
    classes: dict[tuple[int, ...], list[int]] = {}
    for number in range(len(grounding.problem.scenarios)):
        key = tuple(id(law.laws[number]) for law in dependent.values())
        classes.setdefault(key, []).append(number)
    found = []
    for members in classes.values():
        weight = math.fsum(grounding.problem.scenarios[number].probability for number in members)
        laws, parts = (_given(laws, members[0]) for laws in (grounding.laws, grounding.part_laws))
        found.append(GivenScenario(weight, replace(grounding, laws=laws, part_laws=parts)))
    return found


def all_are_certain(given: Sequence[GivenScenario]) -> bool:
    """Tell whether no cost is uncertain once the scenario is known."""
    return all(
        law.least == law.most for scenario in given for law in {*scenario.grounding.laws, *scenario.grounding.part_laws}
    )


def _given(laws: Sequence[CostLaw], scenario: int) -> tuple[CostLaw, ...]:
    return tuple(law.laws[scenario] if isinstance(law, ScenarioCost) else law for law in laws)
