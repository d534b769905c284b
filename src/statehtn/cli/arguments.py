"""The options of the command line."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any

from statehtn.cli.completion_command import add_completion
from statehtn.cli.epilogs import COMPARE_EPILOG, TOP_EPILOG, plan_epilog
from statehtn.cli.formats import FORMATS
from statehtn.cli.model_arguments import add_check, add_why
from statehtn.cli.parser import Parser
from statehtn.cli.policy_arguments import add_export, add_policy
from statehtn.cli.risk_arguments import add_atlas, add_attitude, add_compare_attitudes
from statehtn.cli.shared_options import (
    add_agent,
    add_failing,
    add_inputs,
    add_keep,
    add_limits,
    add_objective,
    count,
)
from statehtn.cli.streams import emit
from statehtn.compatible import HEURISTIC_CHOICES, NOTHING, SOLVERS, SWITCHES
from statehtn.core.heuristics import ADMISSIBLE, HEURISTICS
from statehtn.core.plan_based import BRANCHES
from statehtn.core.searches import SEARCHES, TAKES
from statehtn.core.top_plans import DISTINCT
from statehtn.errors import UsageError
from statehtn.experiments.suites import DEFAULTS, SUITES
from statehtn.risk import Attitude
from statehtn.settings import DEFAULT_WEIGHT


class _ShowVersion(argparse.Action):
    """Print the version; it is looked up only when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object, **__: object) -> None:
        import platform

        import statehtn
        from statehtn.core.compiler import COMPILER

        python = f"Python {platform.python_version()} on {platform.system()} {platform.machine()}"
        emit(f"statehtn {statehtn.__version__} (core: {COMPILER}; {python})")
        parser.exit()


def parse_arguments(arguments: Sequence[str]) -> argparse.Namespace:
    """Parse the command line.

    Raises:
        UsageError: the command line makes no sense.
        SystemExit: help or the version was asked for and printed.
    """
    parser, commands = _parsers()
    chosen = next((commands.choices[word] for word in arguments if word in commands.choices), parser)
    chosen.check_options(arguments)
    return _with_stdin(parser.parse_args(arguments))


def make_parser() -> Parser:
    """Return the parser of the whole command line, for what is made of it: completion, and a manual page."""
    return _parsers()[0]


def _parsers() -> tuple[Parser, argparse._SubParsersAction[Parser]]:
    parser = Parser(prog="statehtn", description="Optimal hierarchical (HTN) planning under risk.", allow_abbrev=False)
    parser.add_argument("--version", action=_ShowVersion, nargs=0, help="print the version and exit")
    commands = parser.add_subparsers(
        dest="command",
        required=True,
        metavar="plan|policy|top|validate|check|why|compare-attitudes|atlas|attitude|compare|report|graph|export|"
        "completion",
    )
    _add_plan(commands)
    add_policy(commands)
    _add_top(commands)
    _add_validate(commands)
    add_check(commands)
    add_why(commands)
    add_compare_attitudes(commands)
    add_atlas(commands)
    add_attitude(commands)
    _add_compare(commands)
    _add_report(commands)
    _add_graph(commands)
    add_export(commands)
    add_completion(commands)
    return parser, commands


def _with_stdin(options: argparse.Namespace) -> argparse.Namespace:
    """Let `-` stand for standard input where a file is read.

    Raises:
        UsageError: it stands for two files.
    """
    dashes = [name for name in ("domain", "problem", "plan", "costs") if getattr(options, name, None) == "-"]
    if len(dashes) > 1:
        raise UsageError(f"standard input can be one file only, found '-' for {' and '.join(dashes)}")
    for name in dashes:
        setattr(options, name, "/dev/stdin")
    return options


def _add_plan(commands: argparse._SubParsersAction[Parser]) -> None:
    parser = commands.add_parser(
        "plan",
        help="find the best plan, for an agent's attitude to risk or any other objective",
        description="Find the plan with the maximum expected utility for an agent's attitude to risk, or the best one "
        "by another objective, and prove it.",
        epilog=plan_epilog(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add_inputs(parser)
    add_objective(parser)
    add_failing(parser.add_argument_group("policies, where actions have several outcomes"))
    search = parser.add_argument_group("the search")
    search.add_argument(
        "--solver",
        choices=list(SOLVERS),
        default="state",
        help="over states and task networks (default), or over task networks alone",
    )
    search.add_argument(
        "--heuristic",
        choices=HEURISTIC_CHOICES,
        help="default: auto; ff for greedy search; tdg for the solver plan",
    )
    search.add_argument(
        "--search",
        choices=list(SEARCHES),
        default="astar",
        help="default: astar; anytime, too, goes on until the plan is proven optimal",
    )
    search.add_argument(
        "--weight", type=float, metavar="W", help=f"of the weighted search, at least 1; default: {DEFAULT_WEIGHT:g}"
    )
    search.add_argument(
        "--branch",
        choices=list(BRANCHES),
        help="of the solver plan: decompose the task of a network with the fewest methods (default), or every one",
    )
    search.add_argument(
        "--without",
        default=NOTHING,
        metavar="NAME[+NAME]",
        help=f"leave out refinements, to see what they are worth; the optimum is the same: {', '.join(SWITCHES)}",
    )
    add_limits(search)
    output = parser.add_argument_group("output")
    output.add_argument("--output", metavar="FILE", help="write the plan with its decomposition (IPC 2020 format)")
    form = output.add_mutually_exclusive_group()
    form.add_argument(
        "--format",
        choices=FORMATS,
        default="table",
        help="what to print: the result as a table (default) or as one JSON object, the plan's actions as CSV, or the "
        "plan with its decomposition in the IPC 2020 format",
    )
    form.add_argument("--json", dest="format", action="store_const", const="json", help="short for --format json")
    form.add_argument("--quiet", action="store_true", help="print the plan's actions only, one per line")


def _add_top(commands: argparse._SubParsersAction[Parser]) -> None:
    parser = commands.add_parser(
        "top",
        help="find the K best plans",
        description="Find the K plans with the highest expected utility for an agent's attitude to risk, or the K best "
        "by another objective, and prove it. Where there are fewer, all are printed.",
        epilog=TOP_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("k", type=count, metavar="K", help="how many plans")
    add_inputs(parser)
    add_objective(parser)
    search = parser.add_argument_group("the search")
    search.add_argument(
        "--distinct",
        choices=list(DISTINCT),
        default="sequence",
        help="plans differ in the sequence of their actions (default), or plans with the same actions in another order "
        "are one",
    )
    search.add_argument(
        "--heuristic",
        choices=list(HEURISTICS),
        metavar=f"{{{','.join(ADMISSIBLE)}}}",  # why it takes no others, the search says itself
        help=f"default: {TAKES['state', 'top'][0]}",
    )
    add_limits(search)
    output = parser.add_argument_group("output")
    output.add_argument(
        "--output", metavar="DIR", help="write each plan with its decomposition (IPC 2020 format) into this folder"
    )
    form = output.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print the result as one JSON object")
    form.add_argument("--quiet", action="store_true", help="print the plans' actions only, one plan per line")


def _add_validate(commands: argparse._SubParsersAction[Parser]) -> None:
    parser = commands.add_parser(
        "validate",
        help="check a plan and its decomposition",
        description="Check a plan with its decomposition (IPC 2020 format), independently of the search; or a list of "
        "actions, one in each line, for which a decomposition is searched.",
        epilog="Exit codes: 0 valid, 1 invalid, 2 usage, 20 time limit, 21 memory limit, 30 input error, "
        "31 unsupported feature.",
        allow_abbrev=False,
    )
    add_inputs(parser)
    parser.add_argument("plan", metavar="PLAN", help="plan file; - for standard input")
    add_limits(parser)
    parser.add_argument("--json", action="store_true", help="print the verdict as one JSON object")


def _add_compare(commands: argparse._SubParsersAction[Parser]) -> None:
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


def _add_report(commands: argparse._SubParsersAction[Parser]) -> None:
    parser = commands.add_parser(
        "report",
        help="write a page about the results of a comparison",
        description="Write one page of HTML about the results of 'statehtn compare': the paper's tables beside these, "
        "the distributions of the plans' costs, the solvers against each other, coverage. It needs no network.",
        epilog="Exit codes: 0 written, 2 usage, 30 input error, 74 cannot write.",
        allow_abbrev=False,
    )
    parser.add_argument("results", metavar="FILE.csv", help="the table of results; FILE.jsonl is expected beside it")
    parser.add_argument("--output", metavar="FILE.html", required=True, help="the page")


def _add_graph(commands: argparse._SubParsersAction[Parser]) -> None:
    parser = commands.add_parser(
        "graph",
        help="write the task decomposition graph, or the relaxed model",
        description="Write a graph of the problem: the task decomposition graph of the domain (cv-tdg), that of the "
        "ground problem with the least risk cost of every task and method for an agent (gcv-tdg), or the relaxed model "
        "of the initial state and network.",
        epilog="Exit codes: 0 written, 2 usage, 30 input error, 31 unsupported feature, 74 cannot write.",
        allow_abbrev=False,
    )
    add_inputs(parser)
    parser.add_argument(
        "--kind", choices=("cv-tdg", "gcv-tdg", "relaxed-model"), default="gcv-tdg", help="default: gcv-tdg"
    )
    add_agent(parser)
    parser.add_argument("--output", metavar="FILE", required=True, help="*.svg, *.dot, *.gv or *.graphml; - for stdout")
    parser.add_argument(
        "--format", choices=("svg", "dot", "graphml"), help="what to write; default: as the name of FILE ends"
    )
