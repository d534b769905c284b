"""Why there is no policy, or that there is one, in lines."""

from __future__ import annotations

import math
from collections.abc import Iterator

from statehtn.counted import counted, likely
from statehtn.display.policy_result import ENDINGS
from statehtn.display.policy_words import OTHERWISE, conditions
from statehtn.display.words import number, with_unit
from statehtn.explanation.chance import BadOutcome, NoPolicy
from statehtn.model.status import Status
from statehtn.policies.result import PolicyResult
from statehtn.risk import Deadline, Neutral, Quantile, Success

ROUNDING = 1e-9
"""Of probabilities; the search tells none apart that are nearer to each other."""


def policy_lines(found: PolicyResult, chance: NoPolicy | None) -> Iterator[str]:
    """Yield that there is a policy, how likely it is done and what it is worth; or that nothing is known of one.

    Args:
        found: what the search has found.
        chance: what keeps the policy that is most likely done from being done for certain.
    """
    if found.policy is None:
        yield f"It is not known whether there is a policy: {found.reason or ENDINGS[found.status]}"
        return
    done = likely(found.policy.success_probability, found.policy.failure_probability)
    yield f"There is a policy that is done with probability {done}, of {counted(len(found.policy), 'node')}."
    yield f"{_worth(found)}."
    if chance is not None:
        yield from _dead_end_lines(chance)
    yield "'statehtn policy' finds the best one, and shows it."


def _worth(found: PolicyResult) -> str:
    """Return what is known of a policy's value."""
    if isinstance(found.objective, Success):
        if found.status is Status.OPTIMAL:
            return "By 'success' no policy is better: none is done with a higher probability"
        return f"Another one may be done with probability {likely(found.upper_bound or 1.0)}"
    if found.value is None or math.isinf(found.value):
        return f"What it is worth by '{found.objective}' is not known"
    failing = found.settings.failure_cost
    fails = "" if failing is None else f", where failing costs {number(failing)} on top of what was spent"
    if failing is not None and math.isinf(failing):
        fails = ", where failed is late"
    if isinstance(found.objective, Neutral):
        return f"Its expected cost is {number(found.value)}{fails}"
    return f"Its value by '{found.objective}' is finite: {with_unit(found.value, found.objective.unit)}{fails}"


def no_policy_lines(answer: NoPolicy) -> Iterator[str]:
    """Yield why there is no policy by an objective."""
    if answer.most_success == 1:
        yield f"Policies are done with probability 1, but none has a finite value by '{answer.objective}':"
        yield "long loops are not unlikely enough for this agent."
        if answer.loops:
            yield "In the policy of least expected cost these outcomes lead back to where it was:"
            yield from (f"  {_bad_outcome(bad)}" for bad in answer.loops)
        if answer.finite_below is not None:
            yield f"That policy has a finite value for an alpha below {answer.finite_below:.6g}."
        yield "With --failure-cost the agent may give up."
        return
    known = "the most likely one" if answer.is_proven else "the most likely one that was found"
    wanted = "1" if answer.wanted_success == 1 else f"{likely(answer.wanted_success)}, whatever it spends"
    most = f"{known} is done with probability {likely(answer.most_success, answer.failure)}"
    yield f"No policy is done with probability {wanted}: {most}."
    yield from _dead_end_lines(answer)
    yield _advice(answer)


def _dead_end_lines(answer: NoPolicy) -> Iterator[str]:
    if answer.dead_ends:
        yield "After these outcomes nothing is left that could be done:"
        for bad in answer.dead_ends:
            yield f"  {_bad_outcome(bad)}; runs of that policy come to it with probability {likely(bad.reached)}"


def _advice(answer: NoPolicy) -> str:
    """Return with which options there is a policy."""
    success = "--objective success asks for the policy that is most likely done."
    match answer.objective:
        case Quantile() if answer.settings.failure_cost is not None:
            return f"A lower level has a policy, and so has a finite --failure-cost; {success}"
        case Quantile(level=level):
            enough = f"policies count that are done with probability {likely(level)} at least"
            is_one = answer.most_success >= level - ROUNDING
            found = ", and there is one" if is_one else ", and there is none" if answer.is_proven else ""
            return f"With --failure-cost inf failed is late: {enough}{found}. {success[0].upper()}{success[1:]}"
        case Deadline():
            return f"With --failure-cost inf failed is late; {success}"
    return f"With --failure-cost the agent may give up; {success}"


def no_policy_line(answer: NoPolicy) -> str:
    """Return in one line why there is no policy: the outcome that stands in the way most."""
    if answer.loops:
        return f"why: again and again it may come to {_bad_outcome(answer.loops[0])}"
    if answer.dead_ends:
        return f"why: nothing is left that could be done after {_bad_outcome(answer.dead_ends[0])}"
    return "why: runs may go on for ever"


def _bad_outcome(bad: BadOutcome) -> str:
    texts = conditions(bad.others)
    condition = texts[bad.changes]
    if condition == OTHERWISE:
        others = " or ".join(text for changes, text in texts.items() if changes != bad.changes)
        condition = f"it does not come to {others}"
    return f"{bad.action} if {condition}, {likely(bad.probability)}"
