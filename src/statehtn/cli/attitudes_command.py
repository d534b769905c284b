"""`statehtn compare-attitudes`: plan for several agents, and show where their plans part."""

from __future__ import annotations

import argparse
import json

from statehtn.attitudes import AttitudeComparison, compared_objectives
from statehtn.cli.exit_codes import EXIT_CODES, ExitCode
from statehtn.cli.files import read_problem
from statehtn.cli.no_plan import say_why
from statehtn.cli.progress import ProgressLine
from statehtn.cli.signals import let_finish
from statehtn.cli.streams import emit
from statehtn.limits import LimitReached, Limits
from statehtn.model.status import Status
from statehtn.planner import compare_attitudes
from statehtn.result import Result
from statehtn.settings import Settings


def run_compare_attitudes(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code: that of the first agent without a plan, else success.

    Raises:
        StateHtnError: the options or the input are wrong.
        LimitReached: a limit was reached before the input was read.
    """
    limits = Limits.starting_now(options.time_limit, options.memory_limit)
    try:
        problem = read_problem(options, limits)
    except LimitReached as ending:
        if not options.json:
            raise
        return _print(_stopped(options, ending.status), options)
    with ProgressLine(silent=False) as progress:
        comparison = compare_attitudes(
            problem,
            options.alpha,
            objectives=options.objective,
            keep=options.keep,
            precision=options.precision,
            heuristic=options.heuristic,
            search=options.search,
            time_limit=options.time_limit,
            memory_limit=options.memory_limit,
            progress=progress.callback,
        )
    code = _print(comparison, options)
    statuses = {result.status for result in comparison.results}
    has_plans = any(result.largest for result in comparison.results)  # but none that keeps the budgets
    if Status.UNSOLVABLE in statuses and not has_plans and not options.json:
        say_why(problem, limits)
    return code


def _print(comparison: AttitudeComparison, options: argparse.Namespace) -> ExitCode:
    """Print a comparison; return the exit code."""
    let_finish()
    emit(json.dumps(comparison.to_dict(), allow_nan=False) if options.json else str(comparison))
    codes = (EXIT_CODES[result.status] for result in comparison.results)
    return next((code for code in codes if code != ExitCode.SUCCESS), ExitCode.SUCCESS)


def _stopped(options: argparse.Namespace, status: Status) -> AttitudeComparison:
    """Return the comparison of agents none of which has been asked."""
    compared = compared_objectives(options.alpha, None, options.objective)
    how = {name: getattr(options, name) for name in ("heuristic", "search", "keep", "precision")}
    asked = (Settings.of(objective, **how) for objective in compared)
    return AttitudeComparison(tuple(Result(status, settings, stopped=status) for settings in asked))
