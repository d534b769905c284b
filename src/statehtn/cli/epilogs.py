"""What `--help` says at its end."""

from __future__ import annotations

import textwrap

from statehtn.core.heuristics import HEURISTICS, PORTFOLIO
from statehtn.risk import OBJECTIVES
from statehtn.risk.policy_objectives import POLICY_OBJECTIVES

HELP_WIDTH = 100
_AUTO = (
    "three searches in turn, which share what they prove: with tdg, with lmcut, and with potential-hmax, potential "
    "and lmcut one after the other"
)

WRITING = (
    "An output file for which there is no directory, say, is wrong usage (2);\n"
    "where writing fails later (74), the disk is full, say."
)
"""What the help of commands that write files says of the exit codes for that."""

PLAN_EPILOG = f"""objectives:
{{}}

heuristics:
{{}}

exit codes:
  0 plan found    10 proven unsolvable    20 time limit      30 input error             74 cannot write
  2 usage         12 search exhausted     21 memory limit    31 unsupported feature     130 interrupted
{WRITING}
"""

POLICY_EPILOG = f"""objectives:
{{}}

exit codes:
  0 policy found  10 proven unsolvable    20 time limit      30 input error             74 cannot write
  2 usage         12 search exhausted     21 memory limit    31 unsupported feature     130 interrupted
{WRITING}
"""

TOP_EPILOG = f"""exit codes:
  0 plans found   10 proven unsolvable    21 memory limit    31 unsupported feature     130 interrupted
  2 usage         20 time limit           30 input error     74 cannot write
What was found before a limit is printed, with exit code 0; the output says how much of it is proven.
{WRITING}
"""

COMPARE_EPILOG = f"""suites:
  paper            what the paper reports: vehicles and satellites, by all solvers
  satellite-large  satellites of the size at which the paper's planner had no memory left, by all solvers
  ipc              every problem in a folder (--root), such as the competition's benchmarks
  FILE.toml        one's own (docs/compare.md)
The suite says with what its problems are run; settings given here count instead. What a solver does not know is left
out: --solver state plan --heuristic lmcut tdg are three combinations.

statuses of a run, besides those of 'statehtn plan':
  input-error, unsupported   its input is wrong, or asks for something that the planner does not do
  error                      it crashed, was killed from outside (see --retry), or its plan did not pass validation
  killed                     it overran a limit and did not end of itself, or killed the workers that it ran on

exit codes: 0 every run is recorded, 2 usage, 30 wrong suite, folder or file, 69 no cluster, 74 cannot write,
130 interrupted
{WRITING}
"""


def plan_epilog() -> str:
    """Return the end of the help of `statehtn plan`, which describes the objectives and the heuristics."""
    return PLAN_EPILOG.format(
        described({form.form: form.meaning for form in {**OBJECTIVES, **POLICY_OBJECTIVES}.values()}),
        described({PORTFOLIO: _AUTO, **{name: info.description for name, info in HEURISTICS.items()}}),
    )


def policy_epilog() -> str:
    """Return the end of the help of `statehtn policy`, which describes the objectives."""
    return POLICY_EPILOG.format(described({form.form: form.meaning for form in POLICY_OBJECTIVES.values()}))


def described(descriptions: dict[str, str]) -> str:
    """Return names with what they mean, one below the other: as wide as the longest name needs."""
    width = max(map(len, descriptions)) + 4
    lines = (
        textwrap.fill(text, HELP_WIDTH, initial_indent=f"  {name}".ljust(width), subsequent_indent=" " * width)
        for name, text in descriptions.items()
    )
    return "\n".join(lines)
