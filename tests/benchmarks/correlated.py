"""How the time of a search grows with the number of days that were observed together.

Usage: python -m tests.benchmarks.correlated [--repeats N] [--markdown FILE.md] [--plot FILE]

Costs of four problems are made to hang together: on each day every action costs its mean, times what four factors
make of it that all actions share, each to an extent of its own. A run prepares and searches; grounding and reading are
told apart. Prints the median seconds of each objective by the number of days; the plot has both axes logarithmic.
"""

from __future__ import annotations

import argparse
import random
import statistics
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from statehtn import Problem, read_hddl
from statehtn.build.cost_table import CostEntry, CostTable, Days
from statehtn.core.grounding import Grounding, ground
from statehtn.core.label_search import search_labels
from statehtn.limits import Limits
from statehtn.model import CostDistribution, CostLaw
from statehtn.risk import Objective, objective
from tests.benchmarks.tables import machine, table

ROOT = Path(__file__).parents[2] / "domains"
PROBLEMS = ("marine/p1", "av/p1", "av/p5", "satellite/RA-4obs-1sat-3mod")
DAYS = (1, 4, 16, 64, 256)
OBJECTIVES = ("cvar 0.9", "deadline", "quantile 0.9", "overrun", "averse")
FACTORS = 4
LIMIT = 60.0  # seconds


@dataclass(frozen=True)
class Run:
    """The median seconds of a search, and how it ended."""

    problem: str
    objective: str
    days: int
    seconds: float
    ending: str


def with_days(problem: Problem, count: int, seed: int = 1) -> Problem:
    """Return the problem with costs of so many days, for all actions that cost anything."""
    draw = random.Random(seed)
    means = {}
    grounding = ground(problem)
    handle = grounding.handle
    for action, schema in enumerate(handle.action_schema):
        lifted = grounding.encoding.actions[schema]
        if lifted is not None and grounding.laws[action].mean > 0:
            means[lifted.name, grounding.objects(handle.action_arguments(action))] = grounding.laws[action].mean
    shares = {instance: [draw.choice((0.0, 0.0, 0.25, 0.5)) for _ in range(FACTORS)] for instance in means}
    days = [[draw.lognormvariate(0, 0.6) - 1 for _ in range(FACTORS)] for _ in range(count)]
    entries = []
    for (name, arguments), mean in means.items():
        laws: list[CostLaw] = []
        for day in days:
            factor = 1 + sum(share * value for share, value in zip(shares[name, arguments], day, strict=True))
            laws.append(CostDistribution.certain(round(max(0.1, mean * factor), 1)))
        entries.append(CostEntry(f"({name})", name, arguments, by_day=tuple(laws)))
    names = tuple(f"day {number}" for number in range(1, count + 1))
    return CostTable((), (), Days("days", names, tuple(entries))).apply(problem)


def objectives(grounding: Grounding) -> Iterator[tuple[str, Objective]]:
    """Yield the objectives, those with a number by the least mean of any plan."""
    *_, best = search_labels(grounding, objective("neutral"))
    mean = next(iter(best.plans)).cost_distribution().mean
    for name in OBJECTIVES:
        number = {"deadline": f" {mean}", "overrun": f" {mean}", "averse": f" {1 / mean}"}.get(name, "")
        yield name, objective(name + number)


def runs(repeats: int) -> Iterator[Run]:
    """Yield the runs of all problems, objectives and numbers of days."""
    for name in PROBLEMS:
        problem = read_hddl(ROOT / name.split("/")[0] / "domain.hddl", ROOT / f"{name}.hddl")
        for days in DAYS:
            grounding = ground(with_days(problem, days))
            for text, wanted in objectives(grounding):
                seconds, endings = [], set()
                for _ in range(repeats):
                    start = time.perf_counter()
                    *_, outcome = search_labels(grounding, wanted, limits=Limits.starting_now(LIMIT))
                    seconds.append(time.perf_counter() - start)
                    endings.add(str(outcome.status))
                yield Run(name, text, days, statistics.median(seconds), ", ".join(sorted(endings)))


def plot(found: list[Run], file: Path) -> None:
    """Draw the seconds against the days, a panel for each problem."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    with matplotlib.rc_context({"svg.hashsalt": "correlated", "font.size": 9}):
        figure, panels = pyplot.subplots(1, len(PROBLEMS), figsize=(12, 3.4), sharey=True, layout="constrained")
        for axes, name in zip(panels, PROBLEMS, strict=True):
            for wanted in OBJECTIVES:
                points = [(run.days, run.seconds) for run in found if (run.problem, run.objective) == (name, wanted)]
                axes.plot(*zip(*points, strict=True), marker="o", markersize=3, label=wanted)
            axes.set(xscale="log", yscale="log", xlabel="days", title=name)
            axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
        panels[0].set_ylabel("seconds")
        panels[0].legend(frameon=False, fontsize=7)
        figure.savefig(file, metadata={"Date": None} if file.suffix == ".svg" else None)


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--plot", type=Path)
    options = parser.parse_args()
    found = list(runs(options.repeats))
    rows = [
        [name, wanted, *(_shown(found, name, wanted, days) for days in DAYS)]
        for name in PROBLEMS
        for wanted in OBJECTIVES
    ]
    lines = table(["problem", "objective", *(f"{days} days" if days > 1 else "1 day" for days in DAYS)], rows)
    text = "\n".join(lines)
    whole = f"{machine()}. Seconds of search and its preparation, median of {options.repeats}.\n\n{text}\n"
    print(whole)
    if options.markdown is not None:
        options.markdown.write_text(f"# Correlated costs: figures\n\n{whole}", encoding="utf-8")
    if options.plot is not None:
        plot(found, options.plot)


def _shown(found: list[Run], problem: str, wanted: str, days: int) -> str:
    (run,) = (run for run in found if (run.problem, run.objective, run.days) == (problem, wanted, days))
    return f"{run.seconds:.2f}" + ("" if run.ending == "optimal" else f" ({run.ending})")


if __name__ == "__main__":
    main()
