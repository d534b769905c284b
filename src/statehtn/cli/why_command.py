"""`statehtn why`: say why there is no plan, or why it is not that plan."""

from __future__ import annotations

import argparse
import json

from statehtn.cli.exit_codes import EXIT_CODES, ExitCode
from statehtn.cli.files import read_problem
from statehtn.cli.plan_files import read_plan_file
from statehtn.cli.shared_options import objective_in, policy_settings_in
from statehtn.cli.signals import let_finish
from statehtn.cli.streams import emit
from statehtn.errors import UsageError
from statehtn.explanation.ask import NO_FAILURE_COST
from statehtn.explanation.explanation import NoPlan, why_no_plan
from statehtn.explanation.given_plan import WhyNot, why_not
from statehtn.limits import LimitReached, Limits
from statehtn.settings import Settings


def run_why(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: the options or the input are wrong.
        LimitReached: a limit was reached before the input was read.
    """
    limits = Limits.starting_now(options.time_limit, options.memory_limit)
    answer: NoPlan | WhyNot
    try:
        problem = read_problem(options, limits)
        if options.plan is None:
            given = options.objective, options.attitude, options.alpha, options.failure_cost
            is_given = any(each is not None for each in given)
            answer = why_no_plan(problem, limits, policy_settings_in(options) if is_given else None)
        else:
            if options.failure_cost is not None:
                raise UsageError(NO_FAILURE_COST)
            settings = Settings.of(objective_in(options))
            answer = why_not(problem, read_plan_file(options.plan, problem, limits), settings, limits)
    except LimitReached as ending:
        if not options.json:
            raise
        answer = NoPlan(ending.status)
    let_finish()
    emit(json.dumps(answer.to_dict(), allow_nan=False) if options.json else str(answer))
    code = EXIT_CODES[answer.status]
    return ExitCode.SUCCESS if code in (ExitCode.UNSOLVABLE, ExitCode.GAVE_UP) else code
