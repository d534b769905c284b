"""The domains whose actions have several outcomes: the values that their pages give."""

from __future__ import annotations

import re
from fractions import Fraction
from functools import cache

import pytest

from tests.explicit_graph import ExplicitGraph, explicit_graph
from tests.explicit_memory import BY_NAME, best_policy_with_memory
from tests.explicit_policies import best_policy
from tests.regression.paper_tables import DOMAINS, problem

ROW = re.compile(r"^\| (p\d) \| ([a-z][^|]*?) \|(?: (\d*) ?\|)? ([\d.]+|infinite) \|$", re.MULTILINE)
ROWS = [
    (name, *match.groups())
    for name in ("gripper-robot", "exploring-rover")
    for match in ROW.finditer((DOMAINS / name / "README.md").read_text())
]


@cache
def graph_of(domain: str, name: str, decomposes_first: bool = False) -> ExplicitGraph:
    return explicit_graph(problem(domain, name), 3000, 20, decomposes_first)


def best(graph: ExplicitGraph, objective: str, failure_cost: str | None) -> Fraction | None:
    price = Fraction(failure_cost) if failure_cost else None
    if objective.split()[0] in BY_NAME:
        return best_policy_with_memory(graph, objective, price).value
    return best_policy(graph, objective, price).value


def test_the_pages_have_results() -> None:
    assert len(ROWS) == 23


@pytest.mark.parametrize("row", ROWS, ids=lambda row: "-".join(filter(None, row)))
def test_results_by_brute_force(row: tuple[str, str, str, str | None, str]) -> None:
    domain, name, objective, failure_cost, printed = row
    value = best(graph_of(domain, name), objective, failure_cost)
    assert (printed == "infinite") == (value is None)
    if value is not None:
        assert float(value) == pytest.approx(float(printed), abs=5.1e-7 if "." in printed else 1e-12)


def test_waiting_pays() -> None:
    """A robot that chooses methods as early as it can knows less."""
    early = graph_of("gripper-robot", "p2", decomposes_first=True)
    assert f"{float(best(early, 'neutral', None)):.2f}" == "12.62"
    assert f"{float(best(early, 'deadline 20', None)):.3f}" == "0.029"
