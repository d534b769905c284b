"""The paper's tables, the problems they are about, and what it means to agree with a printed number.

The tables that the report shows ship with the package; the others are here.
"""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path

import statehtn
from statehtn.experiments.report import paper_tables
from statehtn.model import Plan, Problem
from statehtn.result import Result
from statehtn.validation import validate

FOLDERS = (Path(__file__).parent / "tables", paper_tables.FOLDER)
DOMAINS = Path(__file__).parents[2] / "domains"

ADMISSIBLE_HEURISTICS = ("blind", "tdg", "hmax", "lmcut")


def rows(table: str) -> list[dict[str, str]]:
    """Return the lines of a table as dictionaries of strings, as printed."""
    (path,) = (path for folder in FOLDERS if (path := folder / f"{table}.csv").is_file())
    with path.open(newline="", encoding="utf-8") as file:
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


def alpha_of(row: dict[str, str]) -> float | None:
    """Return the row's alpha; None for the neutral attitude."""
    return float(row["alpha"]) if row["alpha"] else None
