"""The words in which results are told: numbers, agents, endings and effort."""

from __future__ import annotations

from statehtn.counted import counted
from statehtn.effort import Statistics
from statehtn.model.status import Status
from statehtn.result import Result
from statehtn.top_result import TopPlans

Labelled = list[tuple[str, str]]
"""Labels, and what each says."""

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
UNREAD = "but too many tasks to put together before the run ended"
SUCCESS, FAILURE = "bold green", "bold red"
STYLES = {Status.OPTIMAL: SUCCESS, Status.SOLVED: "bold yellow"}
"""How endings are shown; others are failures."""


def number(value: float | None) -> str:
    """Return a number as people write it."""
    return "" if value is None else f"{value:.10g}"


def agent(result: Result | TopPlans) -> str:
    """Return the agent of a result, such as `a risk-averse agent with alpha 0.5`."""
    return f"a risk-{result.attitude} agent" + ("" if result.alpha is None else f" with alpha {number(result.alpha)}")


def head(result: Result | TopPlans) -> str:
    """Return the status and the agent of a result, such as `status: optimal (risk-averse, alpha 0.5)`."""
    alpha = "" if result.alpha is None else f", alpha {result.alpha:g}"
    return f"status: {result.status} (risk-{result.attitude}{alpha})"


def log10_label(result: Result | TopPlans) -> str:
    """Return what the paper's column of logarithms shows for an agent."""
    return "-log10 |EU|" if result.attitude == "averse" else "log10 EU"


def effort_rows(effort: Statistics) -> Labelled:
    """Return what a run has cost, as far as it came."""
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
