"""One run of the planner as data, and grids of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from itertools import product
from typing import cast

from statehtn.errors import UsageError
from statehtn.limits import Limits
from statehtn.risk import AttitudeName, utility_for
from statehtn.settings import Settings, mismatch

Agent = tuple[str, float | None]
"""An attitude to risk and its alpha, None for neutral."""
NEUTRAL: tuple[Agent, ...] = (("neutral", None),)


@dataclass(frozen=True, slots=True)
class Instance:
    """A problem with its domain: the names that the results have, and the files."""

    domain: str
    problem: str
    domain_file: str
    problem_file: str


@dataclass(frozen=True, slots=True)
class Run:
    """A run of the planner: everything that it depends on. Limits are in seconds and in MB, None for no limit."""

    instance: Instance
    attitude: str
    alpha: float | None
    solver: str
    heuristic: str
    search: str
    repeat: int
    time_limit: float | None
    memory_limit: float | None

    @property
    def key(self) -> tuple[str, ...]:
        """What tells the run from others: the first columns of its row. A search other than A* goes with the solver."""
        return (
            self.instance.domain,
            self.instance.problem,
            self.attitude,
            "" if self.alpha is None else repr(self.alpha),
            self.solver if self.search == "astar" else f"{self.solver}/{self.search}",
            self.heuristic,
            str(self.repeat),
        )

    def arguments(self) -> list[str]:
        """Return the command line of this run, without the program's name."""
        optional = (
            ("--alpha", self.alpha),
            ("--time-limit", self.time_limit),
            ("--memory-limit", self.memory_limit),
        )
        return [
            *("plan", "--json", "--attitude", self.attitude),
            *("--solver", self.solver, "--heuristic", self.heuristic, "--search", self.search),
            *(text for name, value in optional if value is not None for text in (name, repr(value))),
            *("--", self.instance.domain_file, self.instance.problem_file),
        ]


@dataclass(frozen=True, slots=True)
class Grid:
    """What every instance is run with: all combinations that exist, `repeat` times. What is not said is None or empty.

    Args:
        agents: neutral alone where nobody is named.
        solvers: `state` where none is named.
        heuristics: the own one of solver and search where none is named.
        searches: `astar` where none is named.
        repeat: at least 1; once where it is not said.
        time_limit: seconds for each run, reading included.
        memory_limit: resident memory of each run in MB (10^6 bytes).
    """

    agents: Sequence[Agent] = ()
    solvers: Sequence[str] = ()
    heuristics: Sequence[str] = ()
    searches: Sequence[str] = ()
    repeat: int | None = None
    time_limit: float | None = None
    memory_limit: float | None = None

    def or_else(self, other: Grid) -> Grid:
        """Return this grid, with what it does not say from the other."""
        values = [(getattr(self, field.name), getattr(other, field.name)) for field in fields(self)]
        return Grid(*(theirs if ours is None or ours == () else ours for ours, theirs in values))

    def combinations(self) -> list[tuple[str, str | None, str]]:
        """Return every solver with every heuristic and search, those included that do not exist."""
        return list(product(self.solvers or ("state",), self.heuristics or (None,), self.searches or ("astar",)))

    def runs(self, instances: Iterable[Instance]) -> list[Run]:
        """Return the runs on these instances: all of them once, then all of them again; none twice.

        Raises:
            UsageError: an agent, a name or a limit makes no sense.
        """
        Limits.starting_now(self.time_limit, self.memory_limit)
        wanted = [
            (agent, Settings.of(utility_for(cast("AttitudeName", agent[0]), agent[1]), solver, heuristic, search))
            for agent in self.agents or NEUTRAL
            for solver, heuristic, search in self.combinations()
            if not mismatch(solver, heuristic, search)
        ]
        runs = [
            Run(
                instance,
                *agent,
                settings.solver,
                settings.heuristic,
                settings.search,
                repeat,
                self.time_limit,
                self.memory_limit,
            )
            for repeat, instance in product(range(1, (self.repeat or 1) + 1), instances)
            for agent, settings in wanted
        ]
        return list(dict.fromkeys(runs))


def agents_of(attitudes: Sequence[str], alphas: Sequence[float]) -> tuple[Agent, ...]:
    """Combine attitudes with alphas; a neutral agent has none, the others each of them.

    Raises:
        UsageError: an alpha is missing, or there is nobody to have it.
    """
    curved = [attitude for attitude in attitudes if attitude != "neutral"]
    if bool(curved) != bool(alphas):
        raise UsageError(f"an agent that is {curved[0]} needs an alpha" if curved else "a neutral agent has no alpha")
    return tuple((attitude, alpha) for attitude in attitudes for alpha in ([None] if attitude == "neutral" else alphas))
