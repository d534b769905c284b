"""Files of plans that commands read: with their decomposition, or lists of actions."""

from __future__ import annotations

from statehtn.errors import InputError
from statehtn.hddl.action_list import read_actions
from statehtn.hddl.plan_format import read_plan
from statehtn.limits import Limits, watched
from statehtn.model import Plan, Problem, Step
from statehtn.read_file import read_whole


def read_plan_file(name: str, problem: Problem, limits: Limits) -> Plan | tuple[Step, ...]:
    """Read a plan with its decomposition, or a list of actions.

    Raises:
        InputError: it is neither, or cannot be read.
        LimitReached: a limit was reached.
    """
    with watched(limits):
        try:
            text = read_whole(name, limits).decode("utf-8")
        except UnicodeDecodeError as error:
            raise InputError(f"'{name}' is no text file: byte {error.start} cannot be decoded") from None
        actions = read_actions(text, problem, name)
        return read_plan(text, problem, name) if actions is None else actions
