"""One run of the planner as data, and grids of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product

from statehtn.errors import UsageError
from statehtn.limits import Limits
from statehtn.planner import Query

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
    """What every instance is run with: all combinations, `repeat` times.

    Args:
        agents: none where the suite is to choose.
        heuristics: None stands for the search's own.
        repeat: at least 1.
        time_limit: seconds for each run, reading included.
        memory_limit: resident memory of each run in MB (10^6 bytes).
    """

    agents: Sequence[Agent] = ()
    solvers: Sequence[str] = ("state",)
    heuristics: Sequence[str | None] = (None,)
    searches: Sequence[str] = ("astar",)
    repeat: int = 1
    time_limit: float | None = None
    memory_limit: float | None = None

    def runs(self, instances: Iterable[Instance], agents: Sequence[Agent] = NEUTRAL) -> list[Run]:
        """Return the runs on these instances, the repetitions apart; `agents` are those of the suite.

        Raises:
            UsageError: a combination or a limit makes no sense.
        """
        Limits.starting_now(self.time_limit, self.memory_limit)
        combinations = list(product(self.agents or agents, self.solvers, self.heuristics, self.searches))
        queries = [
            (agent, Query.of(*agent, solver, heuristic, search)) for agent, solver, heuristic, search in combinations
        ]
        return [
            Run(
                instance,
                *agent,
                query.solver,
                query.heuristic,
                query.search,
                repeat,
                self.time_limit,
                self.memory_limit,
            )
            for repeat, instance in product(range(1, self.repeat + 1), instances)
            for agent, query in queries
        ]


def agents_of(attitudes: Sequence[str], alphas: Sequence[float]) -> tuple[Agent, ...]:
    """Combine attitudes with alphas; a neutral agent has none, the others each of them.

    Raises:
        UsageError: an alpha is missing, or there is nobody to have it.
    """
    curved = [attitude for attitude in attitudes if attitude != "neutral"]
    if bool(curved) != bool(alphas):
        problem = f"an agent that is {curved[0]} needs an alpha" if curved else "a neutral agent has no alpha"
        raise UsageError(f"{problem} (--attitude, --alpha)")
    return tuple((attitude, alpha) for attitude in attitudes for alpha in ([None] if attitude == "neutral" else alphas))
