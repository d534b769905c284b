"""The report as one page of HTML that needs nothing else: no network, no other file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from statehtn.errors import UsageError
from statehtn.experiments.report.cases import Case, agent_order, cases_of, contradictions, order
from statehtn.experiments.report.costs import cost_pictures
from statehtn.experiments.report.duels import MOST_DUELS, duels
from statehtn.experiments.report.paper_tables import compare_with_paper
from statehtn.experiments.report.plots import DASHES, MARKERS, Look, cactus
from statehtn.experiments.report.results import Outcome
from statehtn.experiments.report.tables import all_cases, coverage, effort

FOLDER = Path(__file__).parent
SERIES = 6
"""So many colours there are for series."""
LEAST_SECONDS = 1e-4
MOST_LISTED = 8


@dataclass(frozen=True, slots=True)
class Series:
    """A series of the plots: its name, and how it is drawn."""

    name: str
    look: Look


def report_page(outcomes: Sequence[Outcome], title: str) -> str:
    """Return the page.

    Args:
        outcomes: at least one.
        title: what was compared, such as the name of the file.

    Raises:
        UsageError: a package that it needs is not installed.
    """
    environment = environment_of_pages()
    cases = cases_of(outcomes)
    settings = sorted({case.settings for case in cases}, key=order)
    domains = _series(list(dict.fromkeys(case.domain for case in cases)))
    pictures, certain = cost_pictures(cases)
    page = environment.from_string(_asset("page.html.jinja")).render(
        title=title,
        style=_asset("page.css"),
        script=_asset("page.js"),
        facts=_facts(outcomes, cases, settings),
        contradictions=contradictions(cases),
        several=len(settings) > 1,
        comparisons=compare_with_paper(cases, settings),
        duels=duels(cases, settings, {series.name: series.look for series in domains}),
        left_out=settings[1 + MOST_DUELS :],
        domains=domains if len(domains) > 1 else [],
        cactus=_cactus(cases, settings),
        settings=_series(settings) if len(settings) > 1 else [],
        coverage=coverage(cases, settings),
        effort=effort(cases, settings),
        pictures=pictures,
        certain=certain,
        all_cases=all_cases(cases),
        repeats=max(len(case.outcomes) for case in cases),
    )
    return str(page)


def environment_of_pages() -> Any:
    """Return the template engine, after a look for everything that the page needs.

    Raises:
        UsageError: it is not installed.
    """
    try:
        import jinja2
        import matplotlib  # noqa: F401 - the plots need it
    except ImportError as error:
        raise UsageError(f"a report needs the package '{error.name}': pip install 'statehtn[report]'") from None
    return jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)


def _asset(name: str) -> str:
    return (FOLDER / name).read_text(encoding="utf-8")


def _series(names: Sequence[str]) -> list[Series]:
    """Give each name a look; after six colours they begin again with another marker and dash pattern."""
    markers, dashes = list(MARKERS), list(DASHES)
    return [
        Series(
            name,
            Look(
                f"series-{index % SERIES + 1}",
                markers[(index + index // SERIES) % len(markers)],
                dashes[(index + index // SERIES) % len(dashes)],
            ),
        )
        for index, name in enumerate(names)
    ]


def _cactus(cases: Sequence[Case], settings: Sequence[str]) -> str:
    """Return how many are solved within which time; empty if nothing is."""
    series = []
    for own in _series(settings):
        solved = [case for case in cases if case.settings == own.name and case.is_answered]
        if solved:
            series.append((own.look, [max(case.seconds or 0.0, LEAST_SECONDS) for case in solved]))
    if not series:
        return ""
    label = "How many problems are solved within which time"
    return cactus("cactus", label, "seconds for each", series)


def _facts(outcomes: Sequence[Outcome], cases: Sequence[Case], settings: Sequence[str]) -> list[tuple[str, str]]:
    """Return what the page is about, in a few lines."""
    statuses = Counter(outcome.status for outcome in outcomes)
    agents = sorted({case.agent for case in cases}, key=agent_order)
    problems = len({(case.domain, case.problem) for case in cases})
    domains = len({case.domain for case in cases})
    limits = sorted({outcome.limits for outcome in outcomes}, key=str)
    return [
        ("runs", f"{len(outcomes)}: " + ", ".join(f"{count} {status}" for status, count in statuses.most_common())),
        ("problems", f"{problems} in {domains} domain{'s' if domains != 1 else ''}"),
        ("agents", ", ".join(agents)),
        ("settings", ", ".join(settings)),
        ("limits", "; ".join(_limits_text(*each) for each in limits)),
        ("machine", _listed(outcome.machine for outcome in outcomes)),
        ("statehtn", _listed(outcome.version for outcome in outcomes)),
    ]


def _limits_text(seconds: float | None, megabytes: float | None) -> str:
    time = "no time limit" if seconds is None else f"{seconds:g} s"
    return f"{time}, {'no memory limit' if megabytes is None else f'{megabytes:g} MB'}"


def _listed(names: Iterable[str]) -> str:
    known = list(dict.fromkeys(filter(None, names)))
    more = [f"{len(known) - MOST_LISTED} more"] if len(known) > MOST_LISTED else []
    return ", ".join([*known[:MOST_LISTED], *more]) or "not recorded"
