"""The readable output: tables that fit a terminal, and stay readable in a pipe and without colours."""

from __future__ import annotations

import io
import math
import shutil
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from statehtn.model.law import CostLaw
from statehtn.model.status import Status
from statehtn.result import Result
from statehtn.validate import Validation

if TYPE_CHECKING:
    from statehtn.experiments.summary import Summary

PIPE_WIDTH = 100_000  # in a pipe nothing is wrapped
STYLES = {Status.OPTIMAL: "bold green", Status.SOLVED: "bold yellow"}
ENDINGS = {
    Status.OPTIMAL: "optimal: no plan of this problem has a higher expected utility",
    Status.SOLVED: "solved: there may be a better plan",
    Status.UNSOLVABLE: "unsolvable: it is proven that this problem has no plan",
    Status.EXHAUSTED: "exhausted: the search found no plan, but it does not look everywhere; there may be one",
    Status.TIME_LIMIT: "time limit reached before a plan was found",
    Status.MEMORY_LIMIT: "memory limit reached before a plan was found",
    Status.INTERRUPTED: "interrupted before a plan was found",
}
AGENTS = {"neutral": "a risk-neutral agent", "averse": "a risk-averse agent", "seeking": "a risk-seeking agent"}


def number(value: float | None) -> str:
    """Return a number as people write it."""
    return "" if value is None else f"{value:.10g}"


def readable_result(result: Result) -> str:
    """Return the plan with its price, what was proven, and the effort."""
    parts: list[Table] = []
    if result.plan is not None:
        parts.append(_steps_table(result))
    parts.append(_summary(_summary_rows(result), STYLES.get(result.status, "bold red")))
    return _render(parts)


def readable_validation(validation: Validation, steps: Sequence[object]) -> str:
    """Return the verdict on a plan, action by action; `costs` has a law for each step that can be executed."""
    table = _table(("", "right"), ("action", "left"), ("", "left"), ("cost", "left"), ("expected", "right"))
    for index, step in enumerate(steps):
        if index < len(validation.costs):
            law = validation.costs[index]
            table.add_row(str(index + 1), str(step), "executed", str(law), number(law.mean))
        else:
            state = "not reached" if index > len(validation.costs) else "fails"
            table.add_row(str(index + 1), str(step), state, "", "")
    rows = [("verdict", "valid")] if validation.valid else [("verdict", "invalid")]
    rows += [("because", reason) for reason in validation.reasons]
    if validation.valid:
        rows.append(("expected cost", number(validation.expected_cost)))
    return _render([table, _summary(rows, "bold green" if validation.valid else "bold red")])


def readable_summaries(summaries: Sequence[Summary], total: Summary) -> str:
    """Return what has come of a comparison's runs by domain, and by settings where they differ."""
    several = len({summary.settings for summary in summaries}) > 1
    headings = ("runs", "grounded", "solved", "optimal", "no plan", "limits", "errors")
    times = ("prep. s", "search s", "total s")
    table = _table(
        ("domain", "left"),
        *([("settings", "left")] if several else []),
        *((heading, "right") for heading in (*headings, *times)),
    )
    table.padding = (0, 1, 0, 0)
    for summary in (*summaries, total):
        if summary is total:
            table.add_section()
        counts = (
            *(summary.runs, summary.grounded, summary.solved, summary.optimal),
            *(summary.no_plan, summary.limits, summary.errors),
        )
        seconds = (summary.preparation, summary.search, summary.total)
        table.add_row(
            summary.domain,
            *([summary.settings] if several else []),
            *(str(count) for count in counts),
            *("" if value is None else f"{value:.3f}" for value in seconds),
        )
    explanation = "prep.: median of reading and grounding; search: median over the solved; total: sum over all runs"
    return f"{_render([table], wrap=False)}\n\n{explanation}"


def _steps_table(result: Result) -> Table:
    agent = AGENTS[result.attitude] + ("" if result.alpha is None else f" with alpha {number(result.alpha)}")
    table = _table(
        ("", "right"), ("action", "left"), ("cost", "left"), ("expected", "right"), ("certainty equivalent", "right")
    )
    table.title = f"Plan for {agent}"
    for index, priced in enumerate(result.steps, 1):
        table.add_row(
            str(index), str(priced.step), str(priced.law), number(priced.expected_cost), number(priced.risk_cost)
        )
    table.add_section()
    table.add_row(
        "",
        "in all",
        _range([priced.law for priced in result.steps]),
        number(result.expected_cost),
        number(result.risk_cost),
    )
    return table


def _range(laws: Sequence[CostLaw]) -> str:
    least = sum(law.least for law in laws)
    most = sum(law.most for law in laws)
    if math.isinf(most):
        return f"at least {number(least)}"
    return number(least) if least == most else f"{number(least)} to {number(most)}"


def _summary_rows(result: Result) -> list[tuple[str, str]]:
    found = result.plan is not None
    rows = [("status", ENDINGS[result.status])]
    if found:
        rows.append(("expected cost", number(result.expected_cost)))
        worth = f"{number(result.risk_cost)} (this agent would as soon pay that for certain)"
        rows.append(("certainty equivalent", worth))
        rows.append(("expected utility", result.expected_utility or ""))
    if result.log10_expected_utility is not None:
        label = "-log10 |EU|" if result.attitude == "averse" else "log10 EU"
        rows.append((label, number(result.log10_expected_utility)))
    rows += _bound_row(result)
    rows.append(("problem class", f"{result.problem_class} (solver {result.solver}, heuristic {result.heuristic})"))
    return rows + _effort_rows(result)


def _bound_row(result: Result) -> list[tuple[str, str]]:
    bound, cost = result.lower_bound, result.risk_cost
    if bound is None:
        return []
    text = f"every plan has a certainty equivalent of at least {number(bound)}"
    if cost is None:
        return [("proven", text)]
    gap = cost - bound
    if result.status is Status.OPTIMAL:
        return [("proven", f"to within {gap:.1g} of the certainty equivalent (rounding)")] if gap > 0 else []
    return [("proven", f"{text} (gap {gap:.4g})")]


def _effort_rows(result: Result) -> list[tuple[str, str]]:
    effort = result.statistics
    rows = []
    if effort.facts is not None:
        sizes = f"{effort.facts} facts, {effort.actions} actions, {effort.tasks} tasks, {effort.methods} methods"
        rows.append(("grounded", sizes))
    if effort.expanded is not None:
        nodes = f"{effort.expanded} nodes expanded, {effort.generated} generated, {effort.evaluated} evaluated"
        rows.append(("searched", f"{nodes}, {effort.dead_ends} dead ends"))
    phases = (
        ("reading", effort.parse_seconds),
        ("grounding", effort.ground_seconds),
        ("search", effort.search_seconds),
    )
    times = [f"{name} {seconds:.3f} s" for name, seconds in phases if seconds is not None]
    memory = [] if effort.peak_memory_mb is None else [f"{effort.peak_memory_mb:.0f} MB of memory"]
    return [*rows, ("effort", ", ".join(times + memory))]


def _table(*columns: tuple[str, str]) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, title_justify="left", title_style="bold", header_style="bold")
    for heading, justify in columns:
        table.add_column(heading, justify="right" if justify == "right" else "left")
    return table


def _summary(rows: Iterable[tuple[str, str]], first_style: str) -> Table:
    table = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    table.add_column()
    table.add_column()
    for index, (label, value) in enumerate(rows):
        table.add_row(Text(label, "dim"), Text(value, first_style if index == 0 else ""))
    return table


def _render(tables: Iterable[Table], *, wrap: bool = True) -> str:
    """Render for standard output: coloured and, unless told not to, wrapped on a terminal; plain and wide elsewhere."""
    terminal = sys.stdout.isatty()
    console = Console(
        file=io.StringIO(),
        force_terminal=terminal,
        color_system="auto" if terminal else None,
        width=shutil.get_terminal_size().columns if terminal and wrap else PIPE_WIDTH,
        markup=False,
        highlight=False,
        emoji=False,
    )
    with console.capture() as capture:
        for table in tables:
            console.print(table)
    return "\n".join(line.rstrip() for line in capture.get().splitlines()).strip("\n")
