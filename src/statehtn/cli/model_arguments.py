"""The options of the commands that look at models: what is wrong in them, and why there is no plan."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from statehtn.cli.parser import Parser
from statehtn.cli.shared_options import add_failure_cost, add_inputs, add_limits, add_objective

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[Parser]

CHECK_EPILOG = """examples:
  statehtn check domain.hddl                        what no problem can mend
  statehtn check domain.hddl p1.hddl                with the problem, and what grounding finds out
  statehtn check domain.hddl --format github        annotations for a workflow of GitHub Actions

Each finding is a line: FILE:LINE:COL: level: what it is; what to do [code]. Errors are refused by every command or
leave no plan, warnings are likely slips, notes are neither: what a problem merely does not use is a note.

exit codes:
  0 no errors and no warnings    2 usage             21 memory limit                     74 cannot write
  1 errors or warnings           20 time limit       30 a file cannot be read at all     130 interrupted
"""

WHY_EPILOG = """examples:
  statehtn why domain.hddl p1.hddl                    what cannot be done, and what would help
  statehtn why domain.hddl p1.hddl --plan plan.txt    what is wrong with this plan, or what it costs more than the best
  statehtn why domain.hddl p1.hddl --plan plan.txt --attitude averse --alpha 0.5    ... for this agent

A plan is a file in the IPC 2020 format, or a list of actions, one in each line. What may be added to the problem, and
the points where nothing goes on, are looked for during at most 10 seconds each.

exit codes:
  0 answered      20 time limit      30 input error             74 cannot write
  2 usage         21 memory limit    31 unsupported feature     130 interrupted
"""


def add_check(commands: Commands) -> None:
    """Add `statehtn check`."""
    parser = commands.add_parser(
        "check",
        help="say what is wrong or suspicious in a domain or a problem",
        description="Say what is wrong or suspicious in a domain, or in a domain and a problem: with file, line and "
        "column, and what to do.",
        epilog=CHECK_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("domain", metavar="DOMAIN", help="HDDL file of the domain")
    parser.add_argument("problem", metavar="PROBLEM", nargs="?", help="HDDL file of a problem")
    parser.add_argument("--format", choices=("text", "json", "github"), default="text", help="default: text")
    add_limits(parser)


def add_why(commands: Commands) -> None:
    """Add `statehtn why`."""
    parser = commands.add_parser(
        "why",
        help="say why there is no plan, or why it is not that plan",
        description="Say why a problem has no plan: which task cannot be accomplished, and of each of its methods why "
        "not, down to the roots. Where actions have several outcomes: why it has no policy. With --plan: what a given "
        "plan violates, or what it costs more than the best, and where.",
        epilog=WHY_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add_inputs(parser)
    parser.add_argument("--plan", metavar="FILE", help="ask about this plan; - for standard input")
    agent = add_objective(parser, "the agent, with --plan or where actions have several outcomes", has_budgets=False)
    add_failure_cost(agent)
    add_limits(parser)
    parser.add_argument("--json", action="store_true", help="print the answer as one JSON object")
