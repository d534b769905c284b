"""Numbers as they are shown: probabilities that are not 1, and columns."""

from __future__ import annotations

import re
from fractions import Fraction

import pytest

import statehtn
from statehtn.counted import likely
from statehtn.display.comparison import comparison_text
from statehtn.display.table import on_the_point
from statehtn.display.words import counted_on, value_text
from statehtn.model import CostDistribution, CostSum
from statehtn.model.plan_outcome import PlanOutcome
from statehtn.risk import ValueUnit
from tests.unit.test_why import SLIPPERY, SLIPPERY_ROADS, read


@pytest.mark.parametrize(
    ("probability", "rest", "digits", "text"),
    [
        (1, None, 10, "1"),
        (0, None, 10, "0"),
        (0.5, None, 10, "0.5"),
        (1 - 1e-10, None, 10, "0.9999999999"),
        (1 - 1e-10, None, 6, "1 - 1e-10"),
        (1 - 2**-40, None, 10, "1 - 9.09e-13"),
        (1.0, 1e-20, 10, "1 - 1e-20"),
        (1 - Fraction(1, 10**30), None, 10, "1 - 1e-30"),
        (1e-300, None, 6, "1e-300"),
    ],
)
def test_what_is_not_certain_is_not_shown_as_1(probability: float, rest: float | None, digits: int, text: str) -> None:
    assert likely(probability, rest, digits) == text


def test_probabilities_everywhere() -> None:
    assert counted_on(PlanOutcome(1 - Fraction(1, 10**12))) == "1 - 1e-12: nothing changes"
    assert str(CostDistribution.of([(1 - 1e-9, 4), (1e-9, 7)])) == "4 w.p. 1 - 1e-09, 7 w.p. 1e-09"
    assert value_text(1 - 1e-11, ValueUnit.PROBABILITY) == "1 - 1e-11"
    assert value_text(1 - 2**-53, ValueUnit.PROBABILITY) == "1"  # the rounding of a sum


def test_parts_of_a_cost_that_are_nothing_are_not_shown() -> None:
    free, due = CostDistribution.certain(0), CostDistribution.of([(0.2, 6), (0.8, 11)])
    assert str(CostSum((free, due))) == "6 w.p. 0.2, 11 w.p. 0.8"
    assert str(CostSum((free, free))) == "0"


def test_points_stand_below_each_other() -> None:
    texts = on_the_point(["2.30933332", "0.8931471806", "18", "", "-1e+20", "inf"])
    assert [text.rstrip() for text in texts] == ["  2.30933332", "  0.8931471806", " 18", "", " -1e+20", "inf"]
    assert {len(text) for text in texts} == {14}


def test_where_plans_part_numbers_are_in_columns() -> None:
    problem = read(SLIPPERY_ROADS, SLIPPERY)
    answer = statehtn.why(problem, ["(drive a b)", "(drive b c)"], objective="success-utility alpha=0.1")
    assert answer.more is not None
    first, head, own, best = str(answer).splitlines()
    assert "its value is 0.9755733298" in first
    assert "(log-utility) above that of the best plan" in first
    assert head == "Where they part, with what they count: -ln of probabilities and of utilities:"
    assert own.index(".") == best.index(".")
    assert own.index("(drive") == best.index("in the best plan")


def test_the_reasons_of_a_comparison_are_in_columns() -> None:
    problem = statehtn.read_hddl("domains/av/domain.hddl", "domains/av/p1.hddl")
    shown = comparison_text(statehtn.compare_attitudes(problem, 0.9))
    blocks = [block.splitlines() for block in shown.split("\n\n") if "  instead of (" in block]
    assert blocks
    for _, *lines in blocks:
        assert len({re.match(r" *[0-9]*", line).end() for line in lines}) == 1  # type: ignore[union-attr]
