"""Results of comparisons for tests, written by what `statehtn compare` writes them with."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import statehtn
from statehtn.experiments.record_files import RecordFiles
from statehtn.experiments.records import Record
from statehtn.experiments.run import Instance, Run
from statehtn.risk import objective
from statehtn.settings import Settings

Outcomes = Sequence[tuple[float, float]]


def write(path: Path, records: Iterable[Record]) -> Path:
    """Write a table of results and what belongs beside it; return the table's name."""
    with RecordFiles(str(path)) as files:
        for record in records:
            files.append(record)
    return path


def planned(problem: statehtn.Problem, domain: str, name: str, agent: str = "neutral", **options: Any) -> Record:
    """Plan in this process, and return the record of it."""
    result = statehtn.plan(problem, objective=agent, **options)
    return record(domain, name, agent, solver=result.solver, heuristic=result.heuristic, result=result.to_dict())


def invented(
    domain: str = "errands",
    problem: str = "p1",
    agent: str = "neutral",
    *,
    status: str = "optimal",
    laws: Sequence[Outcomes] | None = ([(0.8, 2.0), (0.2, 9.0)],),
    risk_cost: float = 3.4,
    lower_bound: float | None = 3.4,
    seconds: float = 0.25,
    expanded: int = 7,
    **names: Any,
) -> Record:
    """Return the record of a run that never was; `laws` are those of the plan's actions, None for no plan."""
    plan = None if laws is None else [{"action": f"a{i}", "outcomes": list(law)} for i, law in enumerate(laws)]
    statistics = {"facts": 1, "expanded": expanded, "parse_seconds": 0.0, "search_seconds": seconds}
    result = {
        "status": status,
        "plan": plan,
        "length": plan and len(plan),
        "risk_cost": plan and risk_cost,
        "value": plan and risk_cost,
        "lower_bound": lower_bound,
        "expected_cost": plan and sum(p * cost for law in laws or () for p, cost in law),
        "expected_utility": plan and str(-risk_cost),
        "statistics": {**statistics, "peak_memory_mb": 20.0},
    }
    return record(domain, problem, agent, status=status, result=result, **names)


def record(
    domain: str,
    problem: str,
    agent: str,
    *,
    solver: str = "state",
    heuristic: str = "auto",
    search: str = "astar",
    repeat: int = 1,
    status: str | None = None,
    result: dict[str, Any] | None = None,
) -> Record:
    """Return the record of a run with this result."""
    settings = Settings(objective(agent), solver, heuristic, search, 1.0, "fewest")
    run = Run(Instance(domain, problem, "d", "p"), settings, repeat, 60.0, 4000.0)
    status = status or (result or {}).get("status", "error")
    return Record(run, status, 0, 1.0, "", result, machine="laptop", version=statehtn.__version__)
