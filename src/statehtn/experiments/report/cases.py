"""Cases: a problem for one agent, by one solver with its settings, over all repeats."""

from __future__ import annotations

import math
import re
import statistics
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from statehtn.compatible import HEURISTIC_CHOICES, SOLVERS
from statehtn.experiments.report.results import Agent, Outcome
from statehtn.experiments.summary import SOLVED
from statehtn.model.status import Status

BEST_TO_WORST = (
    *(Status.OPTIMAL, Status.UNSOLVABLE, Status.SOLVED, Status.GAVE_UP),
    *(Status.TIME_LIMIT, Status.MEMORY_LIMIT, "killed", "unsupported", "input-error", "error"),
)
ANSWERS = (*SOLVED, Status.UNSOLVABLE)
TOLERANCE = 1e-6
_NUMBER = re.compile(r"[0-9.]+(e[-+]?[0-9]+)?")
Question = tuple[str, str, Agent]
"""A domain, a problem, an agent."""


@dataclass(frozen=True)
class Case:
    """The outcomes of the repeats of one run; at least one. Times are in seconds."""

    outcomes: Sequence[Outcome]

    @property
    def domain(self) -> str:
        """The domain's name."""
        return self.outcomes[0].domain

    @property
    def problem(self) -> str:
        """The problem's name."""
        return self.outcomes[0].problem

    @property
    def agent(self) -> Agent:
        """The objective, and the budgets to keep."""
        return self.outcomes[0].agent

    @property
    def settings(self) -> str:
        """The solver and the heuristic."""
        return self.outcomes[0].settings

    @property
    def question(self) -> Question:
        """What other settings are asked, too."""
        return self.domain, self.problem, self.agent

    @cached_property
    def status(self) -> str:
        """The worst of all repeats: a case is solved if it always was."""
        return max((outcome.status for outcome in self.outcomes), key=_badness)

    @property
    def is_answered(self) -> bool:
        """Whether there always was a plan, or a proof that there is none."""
        return self.status in ANSWERS

    @cached_property
    def best(self) -> Outcome:
        """The repeat with the best plan; the first one where several are."""
        return min(self.outcomes, key=lambda outcome: float("inf") if outcome.value is None else outcome.value)

    @cached_property
    def seconds(self) -> float | None:
        """The median of reading, grounding and searching."""
        return _median(outcome.seconds for outcome in self.outcomes)

    @cached_property
    def expanded(self) -> float | None:
        """The median of the nodes expanded."""
        return _median(outcome.expanded for outcome in self.outcomes)

    @cached_property
    def memory(self) -> float | None:
        """The median of the peak memory, in MB."""
        return _median(outcome.peak_memory_mb for outcome in self.outcomes)


def cases_of(outcomes: Iterable[Outcome]) -> list[Case]:
    """Put repeats together; sorted by domain, problem and agent, then by settings."""
    groups: dict[tuple[Question, str], list[Outcome]] = {}
    for outcome in outcomes:
        question = outcome.domain, outcome.problem, outcome.agent
        groups.setdefault((question, outcome.settings), []).append(outcome)
    cases = [Case(group) for group in groups.values()]
    return sorted(cases, key=lambda case: (case.domain, case.problem, agent_order(case.agent), order(case.settings)))


def by_question(cases: Iterable[Case]) -> dict[Question, list[Case]]:
    """Return the cases of each question, by settings."""
    found: dict[Question, list[Case]] = {}
    for case in cases:
        found.setdefault(case.question, []).append(case)
    return found


def best_of(cases: Iterable[Case]) -> Outcome | None:
    """Return the best outcome with a plan; of equal ones a proven one, then the first one. None if there is no plan."""
    found = [(case.best.value, case.best) for case in cases if case.best.value is not None]
    if not found:
        return None
    least = min(value for value, _ in found)
    return min(
        (best for value, best in found if value <= least + _margin(least)), key=lambda best: _badness(best.status)
    )


def contradictions(cases: Iterable[Case]) -> list[str]:
    """Return the questions to which proven answers contradict each other, in words.

    They do if one run has proven a lower bound above the value of another's plan, or that there is no plan.
    """
    found = []
    for (domain, problem, agent), group in by_question(cases).items():
        outcomes = [outcome for case in group for outcome in case.outcomes]
        values = [outcome.value for outcome in outcomes if outcome.value is not None]
        if not values:
            continue
        bound = max((outcome.lower_bound for outcome in outcomes if outcome.lower_bound is not None), default=-math.inf)
        what = f"{domain}, {problem}, {agent}"
        if any(outcome.status == Status.UNSOLVABLE for outcome in outcomes):
            found.append(f"{what}: there is a plan, and a proof that there is none")
        elif bound > min(values) + _margin(min(values)):
            found.append(f"{what}: there is a plan of {min(values):.10g}, and a proof that none is below {bound:.10g}")
    return found


def order(settings: str) -> tuple[int, int, str]:
    """Return what settings are sorted by: the order of the planner's own lists, then the alphabet."""
    solver, _, heuristic = settings.partition(" ")
    solvers, heuristics = list(SOLVERS), list(HEURISTIC_CHOICES)
    solver = solver.partition("/")[0]
    return (
        solvers.index(solver) if solver in solvers else len(solvers),
        heuristics.index(heuristic) if heuristic in heuristics else len(heuristics),
        settings,
    )


def agent_order(agent: Agent) -> tuple[float, str]:
    """Return what agents are sorted by: from the most averse over the neutral and others to the most seeking."""
    attitude, _, rest = agent.partition(" ")
    sign = {"averse": -1.0, "seeking": 1.0}.get(attitude, 0.0)
    alpha = rest.partition(" ")[0]
    return sign * (float(alpha) if sign and _NUMBER.fullmatch(alpha) else 0.0), agent


def _badness(status: str) -> int:
    return BEST_TO_WORST.index(status) if status in BEST_TO_WORST else len(BEST_TO_WORST)


def _margin(value: float) -> float:
    return TOLERANCE * max(1.0, abs(value))


def _median(values: Iterable[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return statistics.median(known) if known else None
