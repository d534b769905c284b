"""`statehtn policy`: find a policy, and print the result in the form that was asked for."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from functools import partial

from statehtn.cli.exit_codes import EXIT_CODES, ExitCode
from statehtn.cli.files import OutputFile, read_problem
from statehtn.cli.no_plan import say_why
from statehtn.cli.progress import ProgressLine
from statehtn.cli.shared_options import policy_settings_in
from statehtn.cli.signals import let_finish
from statehtn.cli.streams import emit
from statehtn.decomposition import to_dot, to_svg
from statehtn.errors import UsageError
from statehtn.limits import Limits
from statehtn.model.status import Status
from statehtn.policies.result import PolicyResult
from statehtn.policies.run import find_policy
from statehtn.session import Session


def run_policy(options: argparse.Namespace, session: Session | None = None, limits: Limits | None = None) -> ExitCode:
    """Run the command and return its exit code.

    Args:
        options: those of the command, or of `statehtn plan`.
        session: the problem, where it is read already.
        limits: those of the run, where it has begun already.

    Raises:
        StateHtnError: the options or the input are wrong.
        OutputError: a picture cannot be written.
    """
    settings = policy_settings_in(options)
    inputs = (options.domain, options.problem, options.costs)
    pictures = [
        (OutputFile(name, inputs), form)
        for name, form in ((getattr(options, "dot", None), to_dot), (getattr(options, "svg", None), to_svg))
        if name is not None
    ]
    if sum(file.is_stdout for file, _ in pictures) + options.json > 1:
        raise UsageError("only one of --json, --dot and --svg can go to standard output")
    session = session or Session(partial(read_problem, options))
    limits = limits or Limits.starting_now(options.time_limit, options.memory_limit)
    with ProgressLine(silent=options.quiet) as progress:
        result = find_policy(session, settings, limits, progress.show_policy if progress.visible else None)
    let_finish()
    beside = any(file.is_stdout for file, _ in pictures)
    _print(result, options, beside)
    is_told = options.json or options.quiet or beside
    if result.status is Status.UNSOLVABLE and session.problem is not None and not is_told:
        say_why(session.problem, limits, settings)
    _draw(result, pictures)
    return EXIT_CODES[result.status]


def _print(result: PolicyResult, options: argparse.Namespace, beside: bool) -> None:
    """Print the result; nothing, for people, `beside` a picture on standard output."""
    if options.json:
        emit(json.dumps(result.to_dict(), allow_nan=False))
        return
    if beside:
        return
    from statehtn.display.policy_result import readable_policy
    from statehtn.display.policy_tree import policy_text

    if not options.quiet:
        emit(readable_policy(result, sys.stdout), raw=True)
    elif result.policy is not None:
        emit(policy_text(result.policy.graph))


def _draw(result: PolicyResult, pictures: list[tuple[OutputFile, Callable[..., str]]]) -> None:
    """Write pictures of the policy; where there is none, remove those that another run has left."""
    from statehtn.display.policy_drawing import drawn_policy

    for file, form in pictures:
        if result.policy is None:
            file.remove()
        else:
            file.write(form(drawn_policy(result.policy.graph)))
