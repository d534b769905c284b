"""The options of the commands about comparisons: compare and report."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from statehtn.cli.epilogs import COMPARE_EPILOG, WRITING
from statehtn.cli.parser import Parser
from statehtn.cli.shared_options import add_keep, count
from statehtn.compatible import HEURISTIC_CHOICES, NOTHING, SOLVERS
from statehtn.core.searches import SEARCHES
from statehtn.experiments.suites import DEFAULTS, SUITES
from statehtn.risk import Attitude

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[Parser]


def add_compare(commands: Commands) -> None:
    """Add `statehtn compare`."""
    parser = commands.add_parser(
        "compare",
        help="run a suite of problems with several settings, and record every run",
        description="Run every problem of a suite with every combination of the settings, each run in a process of its "
        "own. Options that take several values may be repeated, too.",
        epilog=COMPARE_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )

    def several(name: str, **options: Any) -> None:
        parser.add_argument(name, action="extend", nargs="+", **options)

    parser.add_argument("--suite", required=True, metavar="NAME|FILE.toml", help=f"{', '.join(SUITES)}, or a file")
    parser.add_argument("--root", metavar="DIR", help="folder of the suite's problems; needed for ipc")
    several("--domain", metavar="GLOB", help="only domains of this name, such as '*Satellite*'")
    several("--problem", metavar="GLOB", help="only problems of this name")
    several("--attitude", choices=[str(attitude) for attitude in Attitude], help="default: the suite's own")
    several("--alpha", type=float, metavar="A", help="for the averse and the seeking")
    several("--objective", metavar="TEXT", help="in the place of attitudes, or beside them, such as 'cvar 0.95'")
    add_keep(parser)
    several("--solver", choices=list(SOLVERS), help="default: the suite's own, else state")
    several("--heuristic", choices=HEURISTIC_CHOICES, help="default: that of solver and search in 'statehtn plan'")
    several("--search", choices=list(SEARCHES), help="default: astar")
    several("--without", metavar="NAME[+NAME]", help=f"as of 'statehtn plan'; '{NOTHING}' is the complete search")
    parser.add_argument("--repeat", type=count, metavar="N", help="do everything so many times, one after the other")
    parser.add_argument(
        "--time-limit",
        type=float,
        metavar="S",
        help=f"seconds for a run, reading included; default: {DEFAULTS.time_limit:g}",
    )
    parser.add_argument(
        "--memory-limit",
        type=float,
        metavar="MB",
        help=f"of a run's process, in 10^6 bytes; default: {DEFAULTS.memory_limit:g}",
    )
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--jobs", type=count, default=1, metavar="N", help="runs at the same time; default: 1")
    where.add_argument(
        "--dask",
        metavar="ADDRESS",
        help="run on the workers of the Dask cluster whose scheduler is there, such as tcp://127.0.0.1:8786",
    )
    parser.add_argument(
        "--output",
        metavar="FILE.csv",
        help="append a row for each run as it ends, and all about it to FILE.jsonl; what is there already is not run "
        "again. Without it rows go to standard output",
    )
    several(
        "--retry",
        choices=["errors", "killed"],
        help="run again what the table has with the status 'error' (crashed, or killed from outside) or 'killed'",
    )
    parser.add_argument("--quiet", action="store_true", help="show no progress and no summary")


def add_report(commands: Commands) -> None:
    """Add `statehtn report`."""
    parser = commands.add_parser(
        "report",
        help="write a page about the results of a comparison",
        description="Write one page of HTML about the results of 'statehtn compare': the paper's tables beside these, "
        "the distributions of the plans' costs, the solvers against each other, coverage. It needs no network.",
        epilog=f"Exit codes: 0 written, 2 usage, 30 input error, 74 cannot write. {WRITING}",
        allow_abbrev=False,
    )
    parser.add_argument("results", metavar="FILE.csv", help="the table of results; FILE.jsonl is expected beside it")
    parser.add_argument("--output", metavar="FILE.html", required=True, help="the page")
