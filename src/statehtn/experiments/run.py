"""One run of the planner as data, and grids of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, fields
from itertools import product
from typing import Any, NamedTuple

from statehtn.compatible import NOTHING, mismatch
from statehtn.errors import UsageError
from statehtn.limits import Limits
from statehtn.risk import Attitude, Keep, Neutral, Objective, agent_in, objective
from statehtn.risk import agents_of as combined
from statehtn.settings import Settings


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
    settings: Settings
    repeat: int
    time_limit: float | None
    memory_limit: float | None

    @property
    def key(self) -> tuple[str, ...]:
        """What tells the run from others: the first columns of its row."""
        settings = self.settings
        return (
            self.instance.domain,
            self.instance.problem,
            str(settings.objective),
            "; ".join(map(str, settings.keep)),
            solver_label(settings.solver, settings.search, settings.without),
            settings.heuristic,
            str(self.repeat),
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the run as the records have it."""
        settings = self.settings
        agent = agent_in(settings.objective)
        return {
            "instance": asdict(self.instance),
            "attitude": None if agent is None else str(agent.attitude),
            "alpha": None if agent is None else agent.alpha,
            "objective": str(settings.objective),
            "keep": list(map(str, settings.keep)),
            "precision": settings.precision,
            "solver": settings.solver,
            "heuristic": settings.heuristic,
            "search": settings.search,
            "without": "+".join(settings.without) or NOTHING,
            "repeat": self.repeat,
            "time_limit": self.time_limit,
            "memory_limit": self.memory_limit,
        }

    def arguments(self) -> list[str]:
        """Return the command line of this run, without the program's name."""
        known = self.to_dict()
        options = ("objective", "precision", "solver", "heuristic", "search", "without", "time_limit", "memory_limit")
        return [
            *("plan", "--json"),
            *(text for budget in known["keep"] for text in ("--keep", budget)),
            *(
                text
                for name in options
                if known[name] is not None
                for text in (f"--{name.replace('_', '-')}", str(known[name]))
            ),
            *("--", self.instance.domain_file, self.instance.problem_file),
        ]


@dataclass(frozen=True, slots=True)
class Grid:
    """What every instance is run with: all combinations that exist, `repeat` times. What is not said is None or empty.

    Args:
        objectives: neutral alone where none is named.
        solvers: `state` where none is named.
        heuristics: the own one of solver and search where none is named.
        searches: `astar` where none is named.
        without: refinements to leave out, as `Settings.of` takes them; the complete search where nothing is said.
        keep: budgets that all plans have to keep.
        precision: as `Settings.of` takes it.
        repeat: at least 1; once where it is not said.
        time_limit: seconds for each run, reading included.
        memory_limit: resident memory of each run in MB (10^6 bytes).
    """

    objectives: Sequence[Objective] = ()
    solvers: Sequence[str] = ()
    heuristics: Sequence[str] = ()
    searches: Sequence[str] = ()
    without: Sequence[tuple[str, ...]] = ()
    keep: Sequence[Keep] = ()
    precision: float | None = None
    repeat: int | None = None
    time_limit: float | None = None
    memory_limit: float | None = None

    def or_else(self, other: Grid) -> Grid:
        """Return this grid, with what it does not say from the other."""
        values = [(getattr(self, field.name), getattr(other, field.name)) for field in fields(self)]
        return Grid(*(theirs if ours is None or ours == () else ours for ours, theirs in values))

    def combinations(self) -> list[Combination]:
        """Return every solver with every heuristic, search, omission and objective, also those that do not exist."""
        return [
            Combination(solver, heuristic, search, without, objective, tuple(self.keep))
            for objective in self.objectives or (Neutral(),)
            for solver in self.solvers or ("state",)
            for heuristic in self.heuristics or (None,)
            for search in self.searches or ("astar",)
            for without in self.without or ((),)
        ]

    def runs(self, instances: Iterable[Instance]) -> list[Run]:
        """Return the runs on these instances: all of them once, then all of them again; none twice.

        Raises:
            UsageError: an objective, a name or a limit makes no sense.
        """
        Limits.starting_now(self.time_limit, self.memory_limit)
        wanted = [one.settings(self.precision) for one in self.combinations() if one.mismatch is None]
        runs = [
            Run(instance, settings, repeat, self.time_limit, self.memory_limit)
            for repeat, instance in product(range(1, (self.repeat or 1) + 1), instances)
            for settings in wanted
        ]
        return list(dict.fromkeys(runs))


class Combination(NamedTuple):
    """What one run is given; it may not exist."""

    solver: str
    heuristic: str | None
    search: str
    without: tuple[str, ...]
    objective: Objective
    keep: tuple[Keep, ...]

    @property
    def mismatch(self) -> str | None:
        """Why there is no such run; None if there is."""
        return mismatch(*self)

    @property
    def label(self) -> str:
        """The solver and its settings, in words."""
        return f"{solver_label(self.solver, self.search, self.without)} {self.heuristic or ''}".strip()

    def settings(self, precision: float | None) -> Settings:
        """Return what one run is to do.

        Raises:
            UsageError: a name or a number makes no sense.
        """
        names = self.solver, self.heuristic, self.search
        return Settings.of(self.objective, *names, without=self.without, keep=self.keep, precision=precision)


def solver_label(solver: str, search: str, without: Sequence[str]) -> str:
    """Return the solver as the table of results has it; a search other than A*, and what it lacks, go with it."""
    lacks = f" without {'+'.join(without)}" if without else ""
    return f"{solver}{'' if search == 'astar' else f'/{search}'}{lacks}"


def objectives_of(
    attitudes: Sequence[str], alphas: Sequence[float], objectives: Sequence[str] = ()
) -> tuple[Objective, ...]:
    """Combine attitudes with alphas, of which a neutral agent has none, the others each; then other objectives.

    Raises:
        UsageError: an alpha is missing, or there is nobody to have it; or there is no such objective.
    """
    curved = [attitude for attitude in attitudes if attitude != "neutral"]
    if bool(curved) != bool(alphas):
        raise UsageError(f"an agent that is {curved[0]} needs an alpha" if curved else "a neutral agent has no alpha")
    return tuple(dict.fromkeys((*combined(map(Attitude, attitudes), alphas), *map(objective, objectives))))
