"""The words in which results are told: numbers, agents, endings and effort."""

from __future__ import annotations

from collections.abc import Iterable

from statehtn.counted import counted, likely
from statehtn.effort import Statistics
from statehtn.model.plan_outcome import PlanOutcome
from statehtn.model.problem import Fact
from statehtn.model.status import Status
from statehtn.result import Result
from statehtn.risk import ValueUnit
from statehtn.top_result import TopPlans

Labelled = list[tuple[str, str]]
"""Labels, and what each says."""

ENDINGS = {
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
ROUNDING = 1e-14
"""Of the sum of a law's probabilities."""
PROBABILITY_ROUNDING = 1e-6
"""Of probabilities; less is not told apart."""
COUNTS_ON = "counts on"
"""The head of a column."""
NO_CLASS = "none of the paper's"
UNREAD = "but too many tasks to put together before the run ended"
SUCCESS, FAILURE = "bold green", "bold red"
STYLES = {Status.OPTIMAL: SUCCESS, Status.SOLVED: "bold yellow"}
"""How endings are shown; others are failures."""


def number(value: float | None) -> str:
    """Return a number as people write it."""
    return "" if value is None else f"{value:.10g}"


def value_text(value: float | None, unit: ValueUnit) -> str:
    """Return a value of an objective as people write it."""
    if value is None or unit is not ValueUnit.PROBABILITY or 1 - value < ROUNDING:
        return number(value)
    return likely(value)


def with_unit(value: float | None, unit: ValueUnit) -> str:
    """Return a value of an objective with its unit, if it is no cost."""
    return value_text(value, unit) if unit is ValueUnit.COST else f"{value_text(value, unit)} ({unit})"


def changes_text(added: Iterable[Fact], deleted: Iterable[Fact], between: str = " and ") -> str:
    """Return which facts become true and which false, as literals; empty where none does."""
    literals = [fact_text(fact) for fact in sorted(added)]
    return between.join(literals + [f"not {fact_text(fact)}" for fact in sorted(deleted)])


def fact_text(fact: Fact) -> str:
    """Return a fact as HDDL has it."""
    return f"({' '.join(fact)})"


def counted_on(outcome: PlanOutcome | None) -> str:
    """Return which outcome a step of a plan counts on, and how likely it is; empty where nothing else may come."""
    if outcome is None or outcome.probability == 1:
        return ""
    changes = changes_text(outcome.added, outcome.deleted, ", ") or "nothing changes"
    return f"{likely(outcome.probability)}: {changes}"


def ending(result: Result | TopPlans) -> str:
    """Return how a run ended, in words."""
    budgets = " and ".join(f"{number(one.budget)} with probability {likely(one.probability)}" for one in result.keep)
    if result.status is Status.UNSOLVABLE and result.largest:
        return f"unsolvable: it is proven that no plan of this problem keeps {budgets}"
    if result.status is not Status.OPTIMAL:
        return ENDINGS[result.status]
    if result.utility is not None:
        better = "has a higher expected utility"
    else:
        better = f"has a lower value of '{result.objective}'"
    return f"optimal: no plan of this problem {f'that keeps {budgets} ' if budgets else ''}{better}{margin(result)}"


def gap_of(result: Result | TopPlans) -> float:
    """Return by how much the last plan may be worse than proven of every plan; 0 where nothing is proven."""
    value = result.value if isinstance(result, Result) else result.plans[-1].value
    return 0.0 if value is None or result.lower_bound is None else value - result.lower_bound


def margin(result: Result | TopPlans) -> str:
    """Return by how much no plan is better, in words: by nothing at all, rounding aside, or by no more than asked."""
    return " by more than the precision" if result.settings.needs_labels and gap_of(result) > 0 else ""


def agent(result: Result | TopPlans) -> str:
    """Return for whom plans are made, such as `for a risk-averse agent with alpha 0.5` or `by 'cvar 0.95'`."""
    if result.utility is None:
        return f"by '{result.objective}'"
    alpha = "" if result.alpha is None else f" with alpha {number(result.alpha)}"
    return f"for a risk-{result.attitude} agent{alpha}"


def head(result: Result | TopPlans) -> str:
    """Return the status and the agent of a result, such as `status: optimal (risk-averse, alpha 0.5)`."""
    if result.utility is None:
        return f"status: {result.status} ({result.objective})"
    alpha = "" if result.alpha is None else f", alpha {result.alpha:g}"
    return f"status: {result.status} (risk-{result.attitude}{alpha})"


def worth(result: Result | TopPlans) -> str:
    """Return what the objective's values are called."""
    return "value" if result.utility is None else "certainty equivalent"


def log10_label(result: Result | TopPlans) -> str:
    """Return what the paper's column of logarithms shows for an agent."""
    return "-log10 |EU|" if result.attitude == "averse" else "log10 EU"


def keep_rows(result: Result | TopPlans) -> Labelled:
    """Return how well each budget is kept, by the plan or, where no plan keeps them all, by the best one for it."""
    rows = []
    for one in result.keep:
        if one.attained is None:
            continue
        best = ""
        if one.at_most is not None and one.at_most - one.attained > PROBABILITY_ROUNDING:
            best = f" by the best plan that was found for it, and {likely(one.at_most)} at most by any"
        elif one.at_most is not None:
            best = " at most, by the plan that is best at it"
        rows.append((f"within {number(one.budget)}", f"with probability {likely(one.attained)}{best}"))
    if not result and len(rows) > 1 and all((one.attained or 0) >= one.probability for one in result.keep):
        rows.append(("together", "each of these budgets can be kept, but no plan keeps all of them"))
    return rows


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
