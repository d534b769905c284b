"""The forms in which `statehtn plan` prints a result."""

from __future__ import annotations

import csv
import io
import json
from typing import TextIO

from statehtn.counted import finite
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.problem import Problem
from statehtn.result import Result

FORMATS = ("table", "json", "csv", "ipc")
COLUMNS = ("step", "action", "arguments", "expected_cost", "risk_cost", "least_cost", "most_cost", "law")


def printed(result: Result, problem: Problem | None, form: str, stream: TextIO) -> str | None:
    """Return a result in a form, for a stream; None where there is nothing to print.

    A table and a JSON object say how a run ended. The other two are a plan; where none was found there is none.
    """
    if form == "json":
        return json.dumps(result.to_dict(), allow_nan=False)
    if form == "table":
        from statehtn.display.result import readable_result

        return readable_result(result, stream)
    if result.plan is None or problem is None:
        return None
    if form == "csv":
        return _csv(result)
    from statehtn.hddl.plan_format import write_plan

    return write_plan(result.plan, problem).rstrip("\n")


def _csv(result: Result) -> str:
    """Return the actions of a plan as rows; an infinite cost is empty, as is a price that does not exist."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for number, priced in enumerate(result.steps, 1):
        law = priced.law
        outcomes = " ".join(f"{p!r}:{cost!r}" for p, cost in law.outcomes) if isinstance(law, CostDistribution) else law
        name = priced.step.action, " ".join(priced.step.arguments)
        writer.writerow((number, *name, priced.expected_cost, priced.risk_cost, law.least, finite(law.most), outcomes))
    return text.getvalue().rstrip("\n")
