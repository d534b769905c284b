"""`statehtn validate`: say whether a plan is valid, action by action."""

from __future__ import annotations

import argparse
import json

from statehtn.cli.exit_codes import EXIT_CODES, ExitCode
from statehtn.cli.files import read_problem
from statehtn.cli.plan_files import read_plan_file
from statehtn.cli.signals import let_finish
from statehtn.cli.streams import emit
from statehtn.hddl.plan_format import write_plan
from statehtn.limits import LimitReached, Limits
from statehtn.model import Step
from statehtn.validation import Validation
from statehtn.verify import validate


def run_validate(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: a file cannot be read.
    """
    from statehtn.display.validation import readable_validation

    limits = Limits.starting_now(options.time_limit, options.memory_limit)
    steps: tuple[Step, ...] = ()
    found = None
    try:
        problem = read_problem(options, limits)
        plan = read_plan_file(options.plan, problem, limits)
        steps = plan if isinstance(plan, tuple) else plan.steps
        validation = validate(problem, plan, limits)
        found = None if validation.plan is None else write_plan(validation.plan, problem)
    except LimitReached as ending:
        steps = ()  # there is nothing to say of them, and there may be millions
        validation = Validation((f"the plan is not checked: {ending} before",), (), stopped=ending.status)
    let_finish()
    if options.json:
        whole = {**validation.to_dict(), "actions": [str(step) for step in steps], "plan": found}
        emit(json.dumps(whole, allow_nan=False))
    else:
        emit(readable_validation(validation, steps), raw=True)
    if validation.stopped is not None:
        return EXIT_CODES[validation.stopped]
    return ExitCode.SUCCESS if validation.valid else ExitCode.INVALID_PLAN
