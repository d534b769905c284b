"""How long proofs take by objectives whose label is not one price, beside the neutral and an exponential agent.

Usage: python -m tests.benchmarks.objectives paper [--repeat N] [--problem PART]
       python -m tests.benchmarks.objectives competition --root DIR --baseline FILE.csv [--every N]
       python -m tests.benchmarks.objectives growth [--plot FILE ...]
with [--output FILE.csv] [--resume] [--markdown FILE.md] each.

paper: the vehicle's P1 to P9 and the 16 totally ordered satellite problems with their own costs, medians of N runs.
competition: of the baseline's problems those that the neutral agent solves within the time limit; a cost c becomes c/2
or 3c/2, half each. growth: time against the step of the costs, the days that were observed, and the number of prices.

With m, the neutral agent's optimum, `averse` and `one-switch` have alpha = 5/m, `one-switch` the tradeoff 1 and the
wealth m. Times are of the search alone, in the process of this program. Grids, bounds and gaps are in the unit of the
objective.
"""

from __future__ import annotations

import argparse
import os
import statistics
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from pathlib import Path

import statehtn
from statehtn import Problem, sweeps
from statehtn.experiments.instances import find_instances
from statehtn.experiments.run import Instance
from statehtn.experiments.suites import SATELLITE_PROBLEMS
from statehtn.limits import Limits
from statehtn.session import Session
from statehtn.settings import Settings
from tests.benchmarks.objective_cases import chain, halved_or_more, on_days
from tests.benchmarks.search import name_of, read_baseline
from tests.benchmarks.tables import add_measuring, figure, geometric_mean, machine, measure_all, table

DOMAINS = Path(__file__).resolve().parents[2] / "domains"
NEUTRAL = "neutral"
COMMON = {
    NEUTRAL: NEUTRAL,
    "averse": "averse {alpha}",
    "one-switch": "one-switch alpha={alpha} tradeoff=1 wealth={m}",
}
PAPER = {
    **COMMON,
    "mean-deviation 1": "mean-deviation 1",
    "evar .95": "evar 0.95",
    "cvar .95": "cvar 0.95",
    "quantile .95": "quantile 0.95",
    "overrun m": "overrun {m}",
    "deadline .95 m": "deadline {below}",
    "deadline m": "deadline {m}",
    "deadline 1.1 m": "deadline {above}",
}
COMPETITION = {**COMMON, **{name: text for name, text in PAPER.items() if name.startswith("deadline")}}
STEPS = ("1", "0.5", "0.2", "0.1", "0.05", "0.02", "0.01")
DAYS = (1, 4, 16, 64, 256)
PRICES = (1, 2, 3, 4, 6, 8)
LEAST_SECONDS = 1e-4  # shorter times count as this


@dataclass(frozen=True)
class Row:
    """A problem and an objective: seconds of search, and values in the objective's unit."""

    problem: str
    objective: str
    text: str = ""
    status: str = ""
    search_seconds: float | None = None
    value: float | None = None
    gap: float | None = None
    expanded: int | None = None
    generated: int | None = None

    @property
    def name(self) -> str:
        return f"{self.problem}, {self.objective}"

    @property
    def solved(self) -> bool:
        return self.status in ("optimal", "unsolvable")


def measure(session: Session, problem: str, label: str, text: str, options: argparse.Namespace) -> Row:
    """Solve a problem that is ground already, several times; the median of the times."""
    results = []
    for _ in range(options.repeat):
        limits = Limits.starting_now(options.time_limit, options.memory_limit)
        results.append(sweeps.solve(again(session), Settings.of(text), limits))
        if results[-1].status == "time-limit":
            break  # the others would take as long
    seconds = statistics.median(result.statistics.search_seconds or 0.0 for result in results)
    last = results[-1]
    effort = last.statistics.expanded, last.statistics.generated
    return Row(problem, label, text, str(last.status), seconds, last.value, last.gap, *effort)


def again(session: Session) -> Session:
    """The same problem, ground, but without prices and all that was found."""
    fresh = Session(session.source)
    fresh._grounding = session._grounding
    return fresh


@lru_cache(maxsize=1)
def grounded(make: Callable[[], Problem], time_limit: float) -> tuple[Session, float | None]:
    """A ground problem, and the neutral agent's optimum; None where that is not found within the limit."""
    session = Session(make())
    best = sweeps.solve(session, Settings.of(), Limits.starting_now(time_limit + 60, 8000.0))
    in_time = (best.statistics.search_seconds or 0.0) <= time_limit
    return session, best.value if best.status == "optimal" and in_time else None


def case(make: Callable[[], Problem], problem: str, label: str, form: str, options: argparse.Namespace) -> Row:
    """Measure an objective whose numbers are multiples of the neutral optimum."""
    session, m = grounded(make, options.time_limit)
    if not m:
        return Row(problem, label, status="no neutral optimum")
    numbers = {"m": m, "alpha": 5 / m, "below": 0.95 * m, "above": 1.1 * m}
    return measure(session, problem, label, form.format(**{key: repr(one) for key, one in numbers.items()}), options)


Cases = Mapping[str, Callable[[], Row]]


def cases_of(
    problems: Iterable[tuple[str, Callable[[], Problem]]], forms: Mapping[str, str], options: argparse.Namespace
) -> Cases:
    return {
        f"{name}, {label}": partial(case, make, name, label, form, options)
        for name, make in problems
        for label, form in forms.items()
    }


def read(instance: Instance) -> Problem:
    return statehtn.read_hddl(instance.domain_file, instance.problem_file)


def read_uncertain(instance: Instance) -> Problem:
    return halved_or_more(read(instance))


def paper_problems(part: str) -> Iterator[tuple[str, Callable[[], Problem]]]:
    names = [("av", f"p{number}") for number in range(1, 10)]
    names += [("satellite", name) for name in SATELLITE_PROBLEMS]
    for domain, name in names:
        if part in f"{domain} {name}":
            files = str(DOMAINS / domain / "domain.hddl"), str(DOMAINS / domain / f"{name}.hddl")
            yield f"{domain} {name}", partial(read, Instance(domain, name, *files))


def competition_problems(options: argparse.Namespace) -> Iterator[tuple[str, Callable[[], Problem]]]:
    instances = {f"{one.domain} {one.problem}": one for one in find_instances(options.root)}
    for line in read_baseline(options.baseline)[:: options.every]:
        instance = instances[name_of(line)]
        if options.problem in name_of(line):
            yield name_of(line), partial(read_uncertain, instance)


def growth_cases(options: argparse.Namespace, folder: Path) -> Cases:
    """Chains of which one thing grows: cells, days, prices."""
    grows: dict[str, tuple[Callable[[], Problem], str]] = {}
    for step in STEPS:
        for text in ("deadline 120", "cvar 0.95"):
            grows[f"step {step}, {text.split()[0]}"] = partial(chain, Fraction(step)), text
    for days in DAYS:
        for text in ("cvar 0.95", "averse 0.05"):
            grows[f"days {days}, {text.split()[0]}"] = partial(on_days, chain(), days, folder), text
    for count in PRICES:
        terms = " ".join(f"{0.02 * (number + 1):g}:{0.1**number:g}" for number in range(count))
        grows[f"prices {count + 1}, exponentials"] = chain, f"exponentials linear=1 {terms}"

    def run(make: Callable[[], Problem], name: str, text: str) -> Row:
        session, _ = grounded(make, options.time_limit)
        problem, label = name.split(", ")
        return measure(session, problem, label, text, options)

    return {name: partial(run, make, name, text) for name, (make, text) in grows.items()}


def seconds_table(rows: list[Row]) -> Iterator[str]:
    """Yield a table of seconds by problem and objective; where the time was not enough, the gap."""
    labels = list(dict.fromkeys(row.objective for row in rows))
    by_problem: dict[str, dict[str, Row]] = {}
    for row in rows:
        by_problem.setdefault(row.problem, {})[row.objective] = row

    def cell(row: Row | None) -> str:
        if row is None or row.search_seconds is None:
            return ""
        return figure(row.search_seconds, ".3f") if row.solved else f"gap {figure(row.gap, '.2g') or 'unknown'}"

    lines = ((problem, *(cell(found.get(label)) for label in labels)) for problem, found in by_problem.items())
    yield from table(("problem, seconds", *labels), lines)


def summary_table(rows: list[Row]) -> Iterator[str]:
    """Yield for each objective how many problems it solves, and its times beside the neutral and the averse agent's."""
    labels = list(dict.fromkeys(row.objective for row in rows))
    known = {(row.problem, row.objective): row for row in rows if row.search_seconds is not None}
    problems = [problem for problem, label in known if label == NEUTRAL]

    def ratio(label: str, other: str) -> str:
        both = ((known.get((problem, label)), known.get((problem, other))) for problem in problems)
        ratios = [
            max(one.search_seconds, LEAST_SECONDS) / max(two.search_seconds, LEAST_SECONDS)
            for one, two in both
            if one is not None and two is not None and one.solved and two.solved
        ]
        return f"{geometric_mean(ratios):.2f}" if ratios else ""

    def lines() -> Iterator[tuple[str, ...]]:
        for label in labels:
            found = [known[problem, label] for problem in problems if (problem, label) in known]
            solved = sum(row.solved for row in found)
            longest = max((row.search_seconds or 0.0 for row in found if row.solved), default=0.0)
            share = f"{solved} of {len(found)} ({solved / len(found):.0%})"
            yield label, share, f"{longest:.2f}", ratio(label, NEUTRAL), ratio(label, "averse")

    yield from table(("objective", "solved", "longest, s", "times neutral", "times averse"), lines())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("paper", "competition", "growth"))
    parser.add_argument("--root", type=Path, default=os.environ.get("STATEHTN_IPC") or None)
    parser.add_argument("--baseline", type=Path, metavar="FILE.csv")
    parser.add_argument("--every", type=int, default=1, help="take every so many of the baseline's problems")
    parser.add_argument("--problem", default="", help="only problems with this part in their names")
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--time-limit", type=float, default=10.0)
    parser.add_argument("--memory-limit", type=float, default=8000.0)
    parser.add_argument("--markdown", type=Path, help="write the tables there as Markdown")
    parser.add_argument("--plot", type=Path, nargs="*", default=[], help="draw how time grows there")
    add_measuring(parser)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if options.what == "paper":
            cases = cases_of(paper_problems(options.problem), PAPER, options)
        elif options.what == "growth":
            cases = growth_cases(options, Path(folder))
        elif options.root is None or options.baseline is None:
            parser.error("name the folder of the benchmarks by --root or STATEHTN_IPC, and the table by --baseline")
        else:
            cases = cases_of(competition_problems(options), COMPETITION, options)
        rows = measure_all(Row, cases, options, line)
    parts = [seconds_table(rows)] if options.what == "growth" else [summary_table(rows), seconds_table(rows)]
    text = "\n\n".join("\n".join(part) for part in parts)
    print(f"\n{text}")
    if options.markdown:
        options.markdown.write_text(f"# Objectives: {options.what}\n\n{machine()}.\n\n{text}\n", encoding="utf-8")
    if options.plot:
        from tests.benchmarks.objectives_plot import draw

        draw(rows, options.plot)


def line(row: Row) -> str:
    """Return what is printed about a row."""
    gap = "" if row.solved else f", gap {figure(row.gap, '.3g') or 'unknown'}"
    return f"{row.name:<60} {row.status:<12} {figure(row.search_seconds, '.4f'):>9} s{gap}"


if __name__ == "__main__":
    main()
