"""The paper's tables, the problems they are about, and what it means to agree with a printed number."""

from __future__ import annotations

import csv
from decimal import Decimal
from functools import cache
from pathlib import Path

import statehtn
from statehtn.model import Plan, Problem
from statehtn.result import Result
from statehtn.validate import validate

TABLES = Path(__file__).parent / "tables"
DOMAINS = Path(__file__).parents[2] / "domains"

ADMISSIBLE_HEURISTICS = ("blind", "tdg", "hmax", "lmcut")


def rows(table: str) -> list[dict[str, str]]:
    """Return the lines of a table as dictionaries of strings, as printed."""
    with (TABLES / f"{table}.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@cache
def problem(domain: str, instance: str) -> Problem:
    """Read a problem of the repository's domains."""
    folder = DOMAINS / domain
    return statehtn.read_hddl(folder / "domain.hddl", folder / f"{instance}.hddl")


def instances(domain: str) -> list[str]:
    """Return the names of a domain's problems."""
    return sorted(path.stem for path in (DOMAINS / domain).glob("*.hddl") if path.stem != "domain")


@cache
def solve(domain: str, instance: str, attitude: str, alpha: float | None, heuristic: str = "lmcut") -> Result:
    """Return the proven best plan; solved once per run of the tests."""
    result = statehtn.plan(problem(domain, instance), attitude=attitude, alpha=alpha, heuristic=heuristic)
    assert result.status == "optimal"
    assert result.plan is not None
    validation = validate(problem(domain, instance), result.plan)
    assert validation.valid, validation.reasons
    return result


def actions(plan: Plan) -> tuple[str, ...]:
    """Return the names of a plan's actions."""
    return tuple(step.action for step in plan.steps)


def agrees(value: object, printed: str) -> bool:
    """Tell whether a value rounds to a printed number: it is off by half a unit of the last printed digit at most."""
    number = Decimal(printed)
    exponent = number.as_tuple().exponent
    assert isinstance(exponent, int)
    half_a_digit = Decimal(1).scaleb(exponent) / 2
    noise = abs(number) * Decimal("1e-12")
    return abs(Decimal(str(value)) - number) <= half_a_digit + noise


def alpha_of(row: dict[str, str]) -> float | None:
    """Return the row's alpha; None for the neutral attitude."""
    return float(row["alpha"]) if row["alpha"] else None
