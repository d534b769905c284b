"""What searches with a single price for each action say of objectives whose prices do not add up."""

from __future__ import annotations

from pathlib import Path

import pytest

import statehtn
from statehtn.core.grounding import ground
from statehtn.core.switches import LabelSwitches
from statehtn.core.valuations import labels_of
from statehtn.limits import Limits

AV = Path(__file__).parents[2] / "domains" / "av"
NEUTRAL = 18.35  # the least mean of a plan


@pytest.mark.parametrize(
    ("text", "bound"),
    [
        ("cvar 0.9", NEUTRAL),
        ("mean-cvar 0.9 0.5", NEUTRAL),
        ("overrun 18", NEUTRAL - 18),
        ("overrun 19", 0),
        ("piecewise 0:0 10:-10 20:-40", 10 + 3 * (NEUTRAL - 10)),
        ("deadline 18", None),
        ("quantile 0.9", None),
    ],
)
def test_the_least_mean_bounds_what_is_averse_to_risk(text: str, bound: float | None) -> None:
    problem = statehtn.read_hddl(AV / "domain.hddl", AV / "p1.hddl")
    objective = statehtn.objective(text)
    labels = labels_of(ground(problem), objective, (), LabelSwitches(), Limits())
    found = next(iter(labels.support(Limits())))
    assert found.bound == (None if bound is None else pytest.approx(bound))
    best = statehtn.plan(problem, objective=text).value
    assert best is not None
    assert found.bound is None or found.bound <= best
