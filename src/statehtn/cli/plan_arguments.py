"""The options of other commands about plans: top, validate and graph."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from statehtn.cli.epilogs import TOP_EPILOG, WRITING
from statehtn.cli.parser import Parser
from statehtn.cli.shared_options import add_agent, add_inputs, add_limits, add_objective, count
from statehtn.core.heuristics import ADMISSIBLE, HEURISTICS
from statehtn.core.searches import TAKES
from statehtn.core.top_plans import DISTINCT

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[Parser]


def add_top(commands: Commands) -> None:
    """Add `statehtn top`."""
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


def add_validate(commands: Commands) -> None:
    """Add `statehtn validate`."""
    parser = commands.add_parser(
        "validate",
        help="check a plan and its decomposition",
        description="Check a plan with its decomposition (IPC 2020 format), independently of the search; or a list of "
        "actions, one in each line, for which a decomposition is searched.",
        epilog="Exit codes: 0 valid, 1 invalid, 2 usage, 20 time limit, 21 memory limit, 30 input error, "
        "31 unsupported feature, 74 cannot write, 130 interrupted.",
        allow_abbrev=False,
    )
    add_inputs(parser)
    parser.add_argument("plan", metavar="PLAN", help="plan file; - for standard input")
    add_limits(parser)
    parser.add_argument("--json", action="store_true", help="print the verdict as one JSON object")


def add_graph(commands: Commands) -> None:
    """Add `statehtn graph`."""
    parser = commands.add_parser(
        "graph",
        help="write the task decomposition graph, or the relaxed model",
        description="Write a graph of the problem: the task decomposition graph of the domain (cv-tdg), that of the "
        "ground problem with the least risk cost of every task and method for an agent (gcv-tdg), or the relaxed model "
        "of the initial state and network.",
        epilog=f"Exit codes: 0 written, 2 usage, 30 input error, 31 unsupported feature, 74 cannot write. {WRITING}",
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
