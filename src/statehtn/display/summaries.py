"""What has come of a comparison's runs, in a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from statehtn.display.table import Column, Table
from statehtn.display.terminal import rendered
from statehtn.experiments.summary import Summary

COUNTS = ("runs", "grounded", "solved", "optimal", "no plan", "limits", "errors")
TIMES = ("prep. s", "search s", "total s")
EXPLANATION = "prep.: median of reading and grounding; search: median over the solved; total: sum over all runs"


def readable_summaries(summaries: Sequence[Summary], total: Summary) -> str:
    """Return what has come of a comparison's runs by domain, and by settings where they differ."""
    several = len({summary.settings for summary in summaries}) > 1
    names = (Column("domain"), *((Column("settings"),) if several else ()))
    columns = (*names, *(Column(head, is_number=True) for head in (*COUNTS, *TIMES)))
    rows = [_row(summary, len(names)) for summary in (*summaries, total)]
    table = rendered([Table(columns, rows[:-1], rows[-1])], wrap=False, between="  ")
    return f"{table}\n\n{EXPLANATION}"


def _row(summary: Summary, names: int) -> tuple[str, ...]:
    counts = (
        *(summary.runs, summary.grounded, summary.solved, summary.optimal),
        *(summary.no_plan, summary.limits, summary.errors),
    )
    seconds = (summary.preparation, summary.search, summary.total)
    return (
        *(summary.domain, summary.settings)[:names],
        *map(str, counts),
        *("" if value is None else f"{value:.3f}" for value in seconds),
    )
