"""Plans that are lists of actions alone, without a decomposition."""

from __future__ import annotations

import re
from collections.abc import Iterable

from statehtn.errors import InputError, Place
from statehtn.expected import expect
from statehtn.hddl.plan_lines import lines_of
from statehtn.hddl.spelling import Spellings
from statehtn.model.plan import Step
from statehtn.model.problem import Problem

_ACTION = re.compile(r"(?:[\d.]+\s*:?\s*)?\(([^()]*)\)\s*(?:\[[\d.]+\])?")
"""`(drive a b)`, also with a number or a time before it, and a duration after it, as planners print them."""
_NUMBERED = re.compile(r"\d+\s+([^()>\s][^()>]*)")
"""`0 drive a b`, as in the IPC 2020 format."""


def read_actions(text: str, problem: Problem, file: str = "<plan>") -> tuple[Step, ...] | None:
    """Read a list of actions, one in each line; None if the text is something else, such as a plan with decomposition.

    A text that says nothing is the empty list, as `plan --quiet` prints a plan without actions.
    Comments (`;`), blank lines and a frame of `==>` and `<==` do not matter; nor does the case of letters.

    Args:
        text: what a planner printed.
        problem: the problem that the plan is for.
        file: what to call the text in errors.

    Raises:
        InputError: a line between actions is none.
    """
    actions, objects = Spellings(problem.domain.actions), Spellings(problem.all_objects)
    known: dict[str, Step | None] = {}  # by line: a long list repeats few; None for what is no action
    steps: list[Step] = []
    wrong: InputError | None = None
    for number, whole in enumerate(lines_of(text), 1):
        line = whole.split(";", 1)[0].strip()
        if not line or line in ("==>", "<=="):
            continue
        if line.lower().startswith("root") or "->" in line:
            return None
        if line not in known:
            match = _ACTION.fullmatch(line) or _NUMBERED.fullmatch(line)
            words = match[1].split() if match else []
            known[line] = _step(words, actions, objects) if words else None
        step = known[line]
        if step is not None:
            steps.append(step)
        elif wrong is None:
            wrong = InputError(f"expected an action such as (drive a b), found '{line}'", Place(file, number, 1))
    if wrong is None:
        return tuple(steps)
    if not steps:
        return None
    raise wrong


def actions_of(lines: Iterable[str | Step], problem: Problem) -> tuple[Step, ...]:
    """Return actions that are given one by one: steps, or texts such as `(drive a b)`.

    Raises:
        UsageError: one is neither.
        InputError: a text is no action.
    """
    actions, objects = Spellings(problem.domain.actions), Spellings(problem.all_objects)
    steps = []
    for line in lines:
        if isinstance(line, Step):
            steps.append(line)
            continue
        expect(line, str, "an action of the plan must be a text such as '(drive a b)' or a step")
        words = line.strip().removeprefix("(").removesuffix(")").split()
        if not words or any(character in word for word in words for character in "()"):
            raise InputError(f"expected an action such as '(drive a b)', found {line!r}")
        steps.append(_step(words, actions, objects))
    return tuple(steps)


def _step(words: list[str], actions: Spellings, objects: Spellings) -> Step:
    """Return a step with the problem's own spelling; names that it does not have are left for the validator."""
    name, *arguments = words
    return Step(actions.find(name) or name, tuple(objects.find(word) or word for word in arguments))
