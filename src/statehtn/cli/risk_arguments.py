"""The options of the commands that are about attitudes to risk: compare-attitudes, atlas and attitude."""

from __future__ import annotations

import argparse
import math

from statehtn.cli.epilogs import WRITING
from statehtn.cli.parser import Parser
from statehtn.cli.shared_options import add_inputs, add_keep, add_limits
from statehtn.compatible import HEURISTIC_CHOICES

ATTITUDE_EPILOG = """examples:
  statehtn attitude --certain 19.4 --lottery "0.5:5 0.5:30"
  statehtn attitude --certain 19.4 --lottery "0.5:5 0.5:30" --certain 12 --lottery "0.9:10 0.1:25"
  statehtn attitude --prefer "19.4 over 0.5:5 0.5:30" --prefer "0.5:5 0.5:30 over 22"

Costs: lower is better. alpha is negative for a risk-seeking person, 0 for a neutral and positive for an averse one:
--attitude averse --alpha A is the agent with alpha = A, --attitude seeking --alpha A that with alpha = -A.

exit codes: 0 answered (contradictions included), 2 usage, 30 a lottery that says nothing, 74 cannot write
"""


def add_compare_attitudes(commands: argparse._SubParsersAction[Parser]) -> None:
    """Add `statehtn compare-attitudes`."""
    parser = commands.add_parser(
        "compare-attitudes",
        help="show the plans of several agents side by side",
        description="Plan for risk-averse, neutral and seeking agents, or by any objectives, and show where their "
        "plans part, what each plan would cost the other agents, and why each does not do what its neighbour does.",
        epilog="Exit codes: as of 'statehtn plan', of the first agent that has no plan; 0 if all have one.",
        allow_abbrev=False,
    )
    add_inputs(parser)
    parser.add_argument(
        "--alpha",
        type=float,
        nargs="+",
        metavar="A",
        help="how much the averse and the seeking agents care, per unit of cost; several for more agents; default: 1",
    )
    parser.add_argument(
        "--objective",
        action="extend",
        nargs="+",
        metavar="TEXT",
        help="what to compare in the place of attitudes, such as neutral 'cvar 0.95'; repeatable",
    )
    add_keep(parser)
    parser.add_argument("--heuristic", choices=HEURISTIC_CHOICES, help="default: that of the search in 'statehtn plan'")
    parser.add_argument("--search", choices=("astar", "anytime", "greedy"), default="astar", help="default: astar")
    add_limits(parser, "seconds for reading, and then for each agent")
    parser.add_argument("--json", action="store_true", help="print the comparison as one JSON object")


def add_atlas(commands: argparse._SubParsersAction[Parser]) -> None:
    """Add `statehtn atlas`."""
    parser = commands.add_parser(
        "atlas",
        help="write a page about one problem: its best plans for every attitude to risk",
        description="Find the best plans of all agents from risk-seeking to risk-averse, those for deadlines and for "
        "wealth, and the frontiers of mean and risk, and write a page of HTML that shows them. It needs no network.",
        epilog="Exit codes: as of 'statehtn plan'; 0 if there is a map, also where a limit has left a part open. "
        f"{WRITING}",
        allow_abbrev=False,
    )
    add_inputs(parser)
    parser.add_argument("--output", metavar="FILE.html", help="the page; - for standard output")
    parser.add_argument(
        "--alpha-from", type=float, default=-math.inf, metavar="A", help="negative for seeking agents; default: -inf"
    )
    parser.add_argument("--alpha-to", type=float, default=math.inf, metavar="A", help="default: inf")
    add_limits(parser, "seconds for everything, reading included; default: none")
    parser.add_argument("--json", action="store_true", help="print what the page shows as one JSON object")


def add_attitude(commands: argparse._SubParsersAction[Parser]) -> None:
    """Add `statehtn attitude`."""
    parser = commands.add_parser(
        "attitude",
        help="find the alpha of a person from what they say about lotteries",
        description="Print the alpha, or the interval of alphas, of a person to whom certain costs are as bad as "
        "uncertain ones, or who prefers one to the other; and which statements contradict each other.",
        epilog=ATTITUDE_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument(
        "--certain",
        type=float,
        action="append",
        default=[],
        metavar="COST",
        help="a certain cost that is exactly as bad as the lottery of the same rank; repeatable",
    )
    parser.add_argument(
        "--lottery",
        action="append",
        default=[],
        metavar="'P:COST ...'",
        help="an uncertain cost: probabilities and costs, as in '0.5:5 0.5:30'; repeatable",
    )
    parser.add_argument(
        "--prefer",
        action="append",
        default=[],
        metavar="'THIS over THAT'",
        help="one of the two is a certain cost, the other one a lottery; repeatable",
    )
    parser.add_argument("--json", action="store_true", help="print the answer as one JSON object")
