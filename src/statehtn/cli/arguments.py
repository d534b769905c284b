"""The options of the command line."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from itertools import takewhile

from statehtn.cli.epilogs import plan_epilog
from statehtn.cli.formats import FORMATS
from statehtn.cli.parser import Parser
from statehtn.cli.shared_options import (
    add_failing,
    add_inputs,
    add_limits,
    add_objective,
)
from statehtn.cli.streams import emit
from statehtn.compatible import HEURISTIC_CHOICES, NOTHING, SOLVERS, SWITCHES
from statehtn.core.plan_based import BRANCHES
from statehtn.core.searches import SEARCHES
from statehtn.errors import UsageError
from statehtn.settings import DEFAULT_WEIGHT

COMMANDS = (
    "plan",
    "policy",
    "top",
    "validate",
    "check",
    "why",
    "compare-attitudes",
    "atlas",
    "attitude",
    "compare",
    "report",
    "graph",
    "export",
    "completion",
)


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
    named = [name for name in arguments[:1] if name in COMMANDS]  # to add the options of all takes a while
    parser, commands = _parsers(named or COMMANDS)
    chosen = next((commands.choices[word] for word in arguments if word in commands.choices), None)
    if chosen is not None:
        chosen.check_options(arguments)
    else:  # whose options stand behind a command that does not exist is not known
        parser.check_options(list(takewhile(lambda word: word.startswith("-"), arguments)))
    return _with_stdin(parser.parse_args(arguments))


def make_parser() -> Parser:
    """Return the parser of the whole command line, for what is made of it: completion, and a manual page."""
    return _parsers(COMMANDS)[0]


def _parsers(names: Sequence[str]) -> tuple[Parser, argparse._SubParsersAction[Parser]]:
    """Return a parser that knows these commands."""
    parser = Parser(prog="statehtn", description="Optimal hierarchical (HTN) planning under risk.", allow_abbrev=False)
    parser.add_argument("--version", action=_ShowVersion, nargs=0, help="print the version and exit")
    commands = parser.add_subparsers(dest="command", required=True, metavar="|".join(COMMANDS))
    for name in names:
        _add(name, commands)
    return parser, commands


def _add(name: str, commands: argparse._SubParsersAction[Parser]) -> None:
    """Add a command with its options; what they need is imported for it alone."""
    match name:
        case "plan":
            _add_plan(commands)
        case "policy" | "export":
            from statehtn.cli.policy_arguments import add_export, add_policy

            (add_policy if name == "policy" else add_export)(commands)
        case "top" | "validate" | "graph":
            from statehtn.cli.plan_arguments import add_graph, add_top, add_validate

            {"top": add_top, "validate": add_validate, "graph": add_graph}[name](commands)
        case "check" | "why":
            from statehtn.cli.model_arguments import add_check, add_why

            (add_check if name == "check" else add_why)(commands)
        case "compare-attitudes" | "atlas" | "attitude":
            from statehtn.cli.risk_arguments import add_atlas, add_attitude, add_compare_attitudes

            {"compare-attitudes": add_compare_attitudes, "atlas": add_atlas, "attitude": add_attitude}[name](commands)
        case "compare" | "report":
            from statehtn.cli.compare_arguments import add_compare, add_report

            (add_compare if name == "compare" else add_report)(commands)
        case _:
            from statehtn.cli.completion_command import add_completion

            add_completion(commands)


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
