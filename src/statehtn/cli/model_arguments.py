"""The options of the commands that look at models: what is wrong in them, and why there is no plan."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from statehtn.cli.parser import Parser
from statehtn.cli.shared_options import add_limits

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[Parser]

CHECK_EPILOG = """examples:
  statehtn check domain.hddl                        what no problem can mend
  statehtn check domain.hddl p1.hddl                with the problem, and what grounding finds out
  statehtn check domain.hddl --format github        annotations for a workflow of GitHub Actions

Each finding is a line: FILE:LINE:COL: level: what it is; what to do [code]. Errors are refused by every command or
leave no plan, warnings are likely slips, notes are neither: what a problem merely does not use is a note.

exit codes:
  0 no errors and no warnings    2 usage             21 memory limit     130 interrupted
  1 errors or warnings           20 time limit       30 a file cannot be read at all
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
