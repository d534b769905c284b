"""What the planner answers where the answer is known: formulas, and the values that the domains' pages give."""

from __future__ import annotations

from fractions import Fraction

import pytest

import statehtn
from statehtn import Problem, Status
from statehtn.experiments.generate.trials import Way, trials_problem
from tests.regression.paper_tables import DOMAINS, problem
from tests.regression.test_policy_domains import ROWS

PRECISION = 1e-10
CLOSE = 1e-9
SIZES = (1, 2, 3, 5, 10, 20)
HALF = Way(Fraction(1, 2))
RISKY, SAFE = Way(Fraction("0.6")), Way(Fraction("0.85"), final=True)


def trials(steps: int, tries: int, *ways: Way) -> Problem:
    return statehtn.read_hddl_text((DOMAINS / "trials/domain.hddl").read_text(), trials_problem(steps, tries, ways))


def must_succeed(asked: Problem, chance: float, expected_cost: float | None = None) -> None:
    result = statehtn.policy(asked, objective="success", precision=PRECISION)
    assert result.status is Status.OPTIMAL
    assert result.value == pytest.approx(chance, abs=CLOSE)
    assert result.lower_bound <= chance + CLOSE
    assert result.upper_bound >= chance - CLOSE
    if expected_cost is not None:
        assert result.expected_cost == pytest.approx(expected_cost, abs=CLOSE)


@pytest.mark.parametrize("size", SIZES)
def test_chains_and_choices(size: int) -> None:
    must_succeed(trials(size, 1, Way(Fraction("0.9"))), 0.9**size, (1 - 0.9**size) / 0.1)
    must_succeed(trials(1, 1, *(Way(Fraction(i, i + 1)) for i in range(1, size + 1))), size / (size + 1), 1)
    must_succeed(trials(1, size, HALF), 1 - 0.5**size, 2 * (1 - 0.5**size))


@pytest.mark.parametrize(("steps", "tries"), [(1, 2), (2, 1), (2, 20), (5, 3), (20, 2), (20, 20)])
def test_steps_with_tries(steps: int, tries: int) -> None:
    must_succeed(trials(steps, tries, HALF), (1 - 0.5**tries) ** steps)
    must_succeed(trials(steps, tries, RISKY, SAFE), (1 - 0.15 * 0.4 ** (tries - 1)) ** steps)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: "-".join(filter(None, row)))
def test_values_of_the_pages(row: tuple[str, str, str, str | None, str]) -> None:
    domain, name, objective, failure_cost, printed = row
    result = statehtn.policy(
        problem(domain, name),
        objective=objective,
        failure_cost=float(failure_cost) if failure_cost else None,
        precision=PRECISION,
    )
    if printed == "infinite":
        assert result.status is Status.UNSOLVABLE
    else:
        assert result.status is Status.OPTIMAL
        assert result.value == pytest.approx(float(printed), abs=5.1e-7 if "." in printed else CLOSE)
