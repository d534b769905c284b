"""The readable output: tables that fit a terminal, and stay readable in a pipe and without colours."""

from __future__ import annotations

import io
import math
import shutil
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, TextIO

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from statehtn.cli.long_table import LongTable
from statehtn.counted import counted
from statehtn.display.top_plans import compact_actions
from statehtn.effort import Statistics
from statehtn.model.cost.law import CostLaw
from statehtn.model.status import Status
from statehtn.result import Result
from statehtn.top_result import TopPlans
from statehtn.validation import Validation

if TYPE_CHECKING:
    from statehtn.experiments.summary import Summary

PIPE_WIDTH = 100_000  # in a pipe nothing is wrapped
STYLES = {Status.OPTIMAL: "bold green", Status.SOLVED: "bold yellow"}
ENDINGS = {
    Status.OPTIMAL: "optimal: no plan of this problem has a higher expected utility",
    Status.SOLVED: "solved: there may be a better plan",
    Status.UNSOLVABLE: "unsolvable: it is proven that this problem has no plan",
    Status.GAVE_UP: "exhausted: the search found no plan, but it does not look everywhere; there may be one",
    Status.TIME_LIMIT: "time limit reached before a plan was found",
    Status.MEMORY_LIMIT: "memory limit reached before a plan was found",
    Status.INTERRUPTED: "interrupted before a plan was found",
}
STOPS = {
    Status.TIME_LIMIT: "time limit reached",
    Status.MEMORY_LIMIT: "memory limit reached",
    Status.INTERRUPTED: "interrupted",
}
NOT_VALIDATED = "no: the run ended before the plan was checked; 'statehtn validate' checks a plan file (--output)"
AGENTS = {"neutral": "a risk-neutral agent", "averse": "a risk-averse agent", "seeking": "a risk-seeking agent"}


def number(value: float | None) -> str:
    """Return a number as people write it."""
    return "" if value is None else f"{value:.10g}"


def readable_result(result: Result, stream: TextIO) -> str:
    """Return the plan with its price, what was proven, and the effort, in the form for a stream."""
    parts: list[Table | LongTable] = []
    if result.plan is not None:
        parts.append(_steps_table(result))
    parts.append(_summary(_summary_rows(result), STYLES.get(result.status, "bold red")))
    return _render(parts, stream=stream)


def readable_validation(validation: Validation, steps: Sequence[object]) -> str:
    """Return the verdict on a plan, action by action; `costs` has a law for each step that can be executed."""
    texts: dict[int, tuple[str, str]] = {}  # of laws, which long plans repeat
    shown = []
    for index, step in enumerate(steps):
        cost = ("", "")
        if index < len(validation.costs):
            law, state = validation.costs[index], "executed"
            if id(law) not in texts:
                texts[id(law)] = str(law), number(law.mean)
            cost = texts[id(law)]
        else:
            fails = index == len(validation.costs) and validation.stopped is None
            state = "fails" if fails else "not reached"
        shown.append((str(index + 1), str(step), state, *cost))
    columns = (("", True), ("action", False), ("", False), ("cost", False), ("expected", True))
    table = LongTable(columns, shown)
    verdict = "valid" if validation.valid else "invalid" if validation.stopped is None else "not decided"
    rows = [("verdict", verdict)]
    if validation.plan is not None:
        rows[0] = ("verdict", "valid: these actions have a decomposition")
        rows += [
            ("" if number else "found", line)
            for number, line in enumerate(str(validation.plan.decomposition).split("\n"))
        ]
    rows += [("because", reason) for reason in validation.reasons]
    if validation.valid:
        rows.append(("expected cost", number(validation.expected_cost)))
    summary = _summary(rows, "bold green" if validation.valid else "bold red")
    return _render([table, summary] if shown else [summary])


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


def readable_top_plans(result: TopPlans) -> str:
    """Return the plans' values, their actions where they differ, what was proven, and the effort."""
    parts: list[Table] = []
    if result.plans:
        parts = [_values_table(result), _actions_table(result)]
    problem_class = f"{result.problem_class} (solver state, heuristic {result.heuristic})"
    rows = [*_top_rows(result), ("problem class", problem_class), *_effort_rows(result.statistics)]
    return _render([*parts, _summary(rows, STYLES.get(result.status, "bold red"))])


def _values_table(result: TopPlans) -> Table:
    is_neutral = result.attitude == "neutral"
    worth = () if is_neutral else ("certainty equivalent",)
    log10 = () if is_neutral else (_log10_label(result),)
    headings = ("", *worth, "expected cost", "expected utility", *log10, "actions", "")
    table = _table(*((heading, "right") for heading in headings))
    count = "The best plan" if len(result) == 1 else f"The {len(result)} best plans"
    if result.proven < len(result):
        count = "The best plan so far" if len(result) == 1 else f"The best {len(result)} plans so far"
    elif result.is_all:
        count = "The only plan" if len(result) == 1 else f"All {len(result)} plans"
    table.title = f"{count} for {_agent(result)}"
    for ranked in result:
        table.add_row(
            str(ranked.rank),
            *(() if is_neutral else (number(ranked.risk_cost),)),
            number(ranked.expected_cost),
            ranked.expected_utility,
            *(() if is_neutral else (number(ranked.log10_expected_utility),)),
            str(ranked.length),
            "" if ranked.is_proven else "not proven",
        )
    return table


def _actions_table(result: TopPlans) -> Table:
    frame, parts = compact_actions(result.plans)
    shared = [("all", frame)] if frame else []
    own = [(str(rank), part) for rank, part in enumerate(parts, 1)]
    return _summary([*shared, *own, ("", "")], "dim" if frame else "")


def _top_rows(result: TopPlans) -> list[tuple[str, str]]:
    others = f"has a certainty equivalent below {number(result.lower_bound)}"
    if not result.plans:
        if result.status is Status.UNSOLVABLE or result.lower_bound is None:
            return [("status", ENDINGS[result.status])]
        return [("status", ENDINGS[result.status]), ("proven", f"no plan {others}")]
    if result.is_all:
        return [("status", "optimal: this problem has no other plans" + _up_to_order(result))]
    if result.status is Status.OPTIMAL:
        rows = [("status", "optimal: no other plan has a higher expected utility" + _up_to_order(result))]
        gap = result.plans[-1].risk_cost - (result.lower_bound or 0)
        return [*rows, ("proven", f"to within {gap:.1g} of the certainty equivalents (rounding)")] if gap > 0 else rows
    if result.stopped is None:
        rows = [("status", "solved: there may be better plans, within the error of the certainty equivalents")]
    else:
        wanted = "a plan was" if result.k == 1 else f"{result.k} plans were"
        rows = [("status", f"{STOPS[result.stopped]} before {wanted} found and proven to be the best")]
    if result.proven:
        which = "these are" if result.proven == len(result) else f"the first {result.proven} are"
        rows.append(("proven", "the first is the best" if result.proven == 1 else f"{which} the best"))
    if result.lower_bound is not None:
        rows.append(("proven", f"no other plan {others}"))
    return rows


def _up_to_order(result: TopPlans) -> str:
    return "" if result.distinct == "sequence" else ", but for these with their actions in another order"


def _agent(result: Result | TopPlans) -> str:
    return AGENTS[result.attitude] + ("" if result.alpha is None else f" with alpha {number(result.alpha)}")


def _log10_label(result: Result | TopPlans) -> str:
    return "-log10 |EU|" if result.attitude == "averse" else "log10 EU"


def _steps_table(result: Result) -> LongTable:
    texts: dict[int, tuple[str, ...]] = {}  # of priced steps, which long plans repeat
    rows = []
    for index, priced in enumerate(result.steps, 1):
        if id(priced) not in texts:
            prices = number(priced.expected_cost), number(priced.risk_cost)
            texts[id(priced)] = (str(priced.step), str(priced.law), *prices)
        rows.append((str(index), *texts[id(priced)]))
    columns = (("", True), ("action", False), ("cost", False), ("expected", True), ("certainty equivalent", True))
    laws = _range([priced.law for priced in result.steps])
    totals = ("", "in all", laws, number(result.expected_cost), number(result.risk_cost))
    return LongTable(columns, rows, totals, f"Plan for {_agent(result)}")


def _range(laws: Sequence[CostLaw]) -> str:
    least = sum(law.least for law in laws)
    most = sum(law.most for law in laws)
    if math.isinf(most):
        return f"at least {number(least)}"
    return number(least) if least == most else f"{number(least)} to {number(most)}"


def _summary_rows(result: Result) -> list[tuple[str, str]]:
    found = result.plan is not None
    why = f" ({STOPS[result.stopped]})" if found and result.stopped is not None else ""
    rows = [("status", ENDINGS[result.status] + why)]
    if found and not result.validated:
        rows.append(("validated", NOT_VALIDATED))
    if found:
        rows.append(("expected cost", number(result.expected_cost)))
        worth = f"{number(result.risk_cost)} (this agent would as soon pay that for certain)"
        rows.append(("certainty equivalent", worth))
        rows.append(("expected utility", result.expected_utility or ""))
    if result.log10_expected_utility is not None:
        rows.append((_log10_label(result), number(result.log10_expected_utility)))
    rows += _bound_row(result)
    rows.append(("problem class", f"{result.problem_class} (solver {result.solver}, heuristic {result.heuristic})"))
    return rows + _effort_rows(result.statistics)


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


def _effort_rows(effort: Statistics) -> list[tuple[str, str]]:
    rows = []
    if effort.facts is not None:
        rows.append(("grounded", effort.sizes))
    if effort.expanded is not None:
        nodes, dead_ends = counted(effort.expanded, "node"), counted(effort.dead_ends or 0, "dead end")
        others = f"{effort.generated} generated, {effort.evaluated} evaluated"
        rows.append(("searched", f"{nodes} expanded, {others}, {dead_ends}"))
    phases = (
        ("reading", effort.parse_seconds),
        ("grounding", effort.ground_seconds),
        ("search", effort.search_seconds),
        ("validation", effort.validate_seconds),
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


def _render(tables: Iterable[Table | LongTable], *, wrap: bool = True, stream: TextIO | None = None) -> str:
    """Render for a stream: coloured and, unless told not to, wrapped on a terminal; plain and wide elsewhere.

    The stream is standard output if none is given.
    """
    terminal = (stream or sys.stdout).isatty()
    console = Console(
        file=io.StringIO(),
        force_terminal=terminal,
        color_system="auto" if terminal else None,
        width=shutil.get_terminal_size().columns if terminal and wrap else PIPE_WIDTH,
        markup=False,
        highlight=False,
        emoji=False,
    )
    parts: list[str] = []
    for table in tables:
        found = table.lay_out(console.width) if isinstance(table, LongTable) else table
        with console.capture() as capture:
            if isinstance(found, Table):
                console.print(found)
            else:
                console.print(Text(found[0], "bold"), soft_wrap=True)
        parts.append("\n".join(line.rstrip() for line in capture.get().splitlines()))
        if not isinstance(found, Table):
            parts.append(found[1])
    return "\n".join(parts).strip("\n")
