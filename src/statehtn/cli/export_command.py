"""`statehtn export`: write the problem, or its best policy, for a model checker."""

from __future__ import annotations

import argparse
import sys
from functools import partial

from statehtn.cli.exit_codes import EXIT_CODES, ExitCode
from statehtn.cli.files import OutputFile, read_problem
from statehtn.cli.shared_options import policy_settings_in
from statehtn.cli.signals import let_finish
from statehtn.cli.streams import emit, say
from statehtn.counted import counted
from statehtn.display.policy_result import readable_policy
from statehtn.effort import Meter
from statehtn.errors import UsageError, one_line
from statehtn.limits import Limits
from statehtn.policies.prism import MarkovModel, chain_of, prism_text
from statehtn.policies.reachable import reachable_model
from statehtn.policies.run import find_policy
from statehtn.session import Session

OF_THE_AGENT = ("objective", "attitude", "alpha", "adaptive", "precision")
"""Options that matter to the best policy alone; giving up at a price is a decision of the process, too."""


def run_export(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: the options or the input are wrong, or the problem cannot be said in that language.
        LimitReached: a limit was reached.
        OutputError: the file cannot be written.
    """
    if not options.policy:
        _refuse_what_policies_have(options)
    settings = policy_settings_in(options)
    output = OutputFile(options.prism, (options.domain, options.problem, options.costs))
    limits = Limits.starting_now(options.time_limit, options.memory_limit)
    session = Session(partial(read_problem, options))
    title = f"{options.domain} {options.problem}"
    model: MarkovModel
    if options.policy:
        result = find_policy(session, settings, limits)
        if result.policy is None:
            output.remove()
            say(readable_policy(result, sys.stderr), raw=True)
            return EXIT_CODES[result.status]
        model = chain_of(result.policy.graph.flat, settings.failure_cost)
        title = f"the best policy of {title} by '{settings.objective}'"
    else:
        grounding = session.ground_for_policies(limits, Meter())
        model = reachable_model(grounding, settings.failure_cost, limits)
    let_finish()
    output.write("\n".join(prism_text(model, one_line(title))) + "\n", limits)
    if not output.is_stdout:
        emit(f"{one_line(options.prism)}: {counted(len(model.done), 'state')}")
    return ExitCode.SUCCESS


def _refuse_what_policies_have(options: argparse.Namespace) -> None:
    """Refuse options that say which policy is wanted, where all decisions are written.

    Raises:
        UsageError: there is one.
    """
    given = [name for name in OF_THE_AGENT if getattr(options, name) not in (None, False)]
    if given:
        raise UsageError(
            f"--{given[0]} says which policy is the best, and without --policy all decisions are written; "
            f"add --policy, or leave --{given[0]} out"
        )
