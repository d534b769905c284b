"""`statehtn plan`: plan, and print the result in the form that was asked for."""

from __future__ import annotations

import argparse
import sys
from functools import partial

from statehtn.cli.exit_codes import EXIT_CODES, ExitCode
from statehtn.cli.files import OutputFile, read_problem
from statehtn.cli.formats import printed
from statehtn.cli.progress import ProgressLine
from statehtn.cli.shared_options import objective_in
from statehtn.cli.signals import let_finish
from statehtn.cli.streams import OutputError, emit, emit_lines, say
from statehtn.compatible import NOTHING, switches_in
from statehtn.core.heuristics import PORTFOLIO
from statehtn.effort import Meter
from statehtn.errors import UsageError
from statehtn.expected import one_of
from statehtn.limits import Limits
from statehtn.model import Plan, Problem
from statehtn.model.status import Status
from statehtn.result import Result
from statehtn.risk import OBJECTIVES, Success, SuccessUtility
from statehtn.risk.objectives import name_in
from statehtn.risk.policy_objectives import POLICY_OBJECTIVES
from statehtn.session import Session
from statehtn.settings import Settings
from statehtn.sweeps import solutions

OF_PLANS: dict[str, tuple[object, ...]] = {
    "solver": ("state",),
    "heuristic": (None, PORTFOLIO),
    "search": ("astar",),
    "weight": (None,),
    "branch": (None,),
    "without": (NOTHING,),
    "keep": ([],),
    "output": (None,),
    "format": ("table", "json"),
}
"""Options that policies do not have, with what they may be nevertheless: their defaults."""


def run_plan(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: the options or the input are wrong.
        OutputError: the plan was found and printed, but could not be written to a file.
    """
    if _asks_for_policy(options):
        return _run_policy(options)
    settings = Settings.of(
        objective_in(options),
        solver=options.solver,
        heuristic=options.heuristic,
        search=options.search,
        weight=options.weight,
        branch=options.branch,
        without=switches_in(options.without),
        keep=options.keep,
        precision=options.precision,
    )
    inputs = (options.domain, options.problem, options.costs)
    output = None if options.output is None else OutputFile(options.output, inputs)
    if output and output.is_stdout and options.format != "table":
        asked = f"the result ({options.format})"
        raise UsageError(f"both {asked} and the plan of --output would go to standard output; leave out one of them")
    limits = Limits.starting_now(options.time_limit, options.memory_limit)
    keeper = _PlanKeeper(output, limits)
    session = Session(partial(_read_for_plans, options, settings))
    every_plan = output is not None and output.is_regular
    result = Result(Status.INTERRUPTED, settings, Meter().read(), Status.INTERRUPTED)
    try:
        with ProgressLine(silent=options.quiet) as progress:
            for result in solutions(session, settings, limits, progress.callback, every_plan):
                if every_plan and session.problem is not None:
                    keeper.keep(result, session.problem)
    except KeyboardInterrupt:  # between two phases
        pass
    except _SeveralOutcomes as found:
        return _run_policy(options, Session(found.problem), limits)
    let_finish()
    keeper.finish(result, session.problem)
    _print(result, session.problem, options, beside=output is not None and output.is_stdout)
    if (
        result.status is Status.UNSOLVABLE
        and session.problem is not None
        and options.format == "table"
        and not options.quiet
        and not result.largest  # there are plans, but none keeps the budgets
    ):
        from statehtn.cli.no_plan import say_why

        say_why(session.problem, limits)
    if keeper.failure is not None:
        raise keeper.failure
    return EXIT_CODES[result.status]


def _asks_for_policy(options: argparse.Namespace) -> bool:
    """Tell whether the options are about policies, whatever the problem.

    Raises:
        UsageError: there are neither plans nor policies by such an objective.
    """
    name = None
    if options.objective is not None:
        name = one_of(name_in(options.objective), {**OBJECTIVES, **POLICY_OBJECTIVES}, "objective")
    return options.adaptive or options.failure_cost is not None or name == str(Success())


class _SeveralOutcomes(Exception):
    """Actions of a problem have several outcomes, so that it has policies and no plans."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        super().__init__()


def _read_for_plans(options: argparse.Namespace, settings: Settings, limits: Limits) -> Problem:
    """Read the problem; a plan answers it where each action has one outcome, or the plan counts on one of them."""
    problem = read_problem(options, limits)
    if problem.domain.has_outcomes and not isinstance(settings.objective, SuccessUtility):
        raise _SeveralOutcomes(problem)
    return problem


def _run_policy(options: argparse.Namespace, session: Session | None = None, limits: Limits | None = None) -> ExitCode:
    """Find a policy instead of a plan.

    Raises:
        UsageError: options are given that only plans have.
    """
    from statehtn.cli.policy_command import run_policy  # what it needs would slow down most runs

    for name, defaults in OF_PLANS.items():
        if getattr(options, name) not in defaults:
            raise UsageError(
                f"--{name.replace('_', '-')} is for plans, and what is asked for is a policy, since actions have "
                "several outcomes or the options ask for one; leave it out"
            )
    options.json = options.format == "json"
    return run_policy(options, session, limits)


class _PlanKeeper:
    """Writes plans to the file of --output; a failure waits, since what was found must be printed first."""

    def __init__(self, output: OutputFile | None, limits: Limits) -> None:
        self.output = output
        self.limits = limits
        self.written: Plan | None = None
        self.failure: OutputError | None = None

    def keep(self, result: Result, problem: Problem) -> None:
        """Write the plan of a result, unless it stands there."""
        if self.output is None or result.plan is None or result.plan is self.written:
            return
        from statehtn.hddl.plan_format import write_plan  # without a file nothing needs it

        self.failure = None
        try:
            self.output.write(write_plan(result.plan, problem), self.limits)
            self.written = result.plan
        except OutputError as error:
            self.failure = error

    def finish(self, result: Result, problem: Problem | None) -> None:
        """Write the last plan; without one, remove the file that another run has left."""
        if problem is not None and result.plan is not None:
            self.keep(result, problem)
        elif self.output is not None:
            try:
                self.output.remove()
            except OutputError as error:
                self.failure = error


def _print(result: Result, problem: Problem | None, options: argparse.Namespace, beside: bool) -> None:
    """Print the result; on standard error, for people, if it stands `beside` a plan on standard output."""
    if options.quiet:
        if result.steps and not beside:
            emit_lines(str(priced.step) for priced in result.steps)
        return
    text = printed(result, problem, options.format, sys.stderr if beside else sys.stdout)
    if text is not None:
        (say if beside else emit)(text, raw=options.format == "table")
    elif not result:
        from statehtn.display.words import ending

        say(ending(result))
