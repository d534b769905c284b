"""Results of searches for policies as text, in a terminal and as HTML."""

from __future__ import annotations

from html import escape
from typing import TextIO

from statehtn.counted import likely
from statehtn.display.policy_tree import policy_text
from statehtn.display.terminal import Summary, rendered
from statehtn.display.words import FAILURE, NO_CLASS, STOPS, STYLES, Labelled, effort_rows, number, with_unit
from statehtn.model.status import Status
from statehtn.policies.result import Looking, PolicyResult
from statehtn.risk import Success

ENDINGS = {
    Status.SOLVED: "solved: there may be a better policy",
    Status.UNSOLVABLE: "unsolvable",
    Status.GAVE_UP: "exhausted: no policy was found, but the search did not look everywhere; there may be one",
    Status.TIME_LIMIT: "time limit reached before a policy was found",
    Status.MEMORY_LIMIT: "memory limit reached before a policy was found",
    Status.INTERRUPTED: "interrupted before a policy was found",
}
ROUNDING = 1e-9
"""Of values; smaller differences are none."""


def policy_result_text(result: PolicyResult) -> str:
    """Return the status, the tree of decisions, and what the policy is worth, in lines."""
    lines = [f"status: {result.status} ({result.objective})"]
    if result.policy is not None:
        lines.append(policy_text(result.policy.graph))
    lines += [f"{label}: {text}" for label, text in _rows(result)[1:]]
    return "\n".join(lines)


def policy_result_html(result: PolicyResult) -> str:
    """Return what `policy_result_text` does as HTML for a notebook."""
    parts = [f"<b>{escape(f'status: {result.status} ({result.objective})')}</b>"]
    if result.policy is not None:
        parts.append(result.policy._repr_html_())
    parts += [f"<div>{escape(f'{label}: {text}')}</div>" for label, text in _rows(result)[1:]]
    return f"<div>{''.join(parts)}</div>"


def readable_policy(result: PolicyResult, stream: TextIO) -> str:
    """Return the tree of decisions, what the policy is worth, what was proven, and the effort, for a stream."""
    rows = [*_rows(result), ("problem class", result.problem_class or NO_CLASS), *effort_rows(result.statistics)]
    summary = rendered([Summary(rows, STYLES.get(result.status, FAILURE))], stream=stream)
    if result.policy is None:
        return summary
    return f"Policy {_by(result)}\n\n{policy_text(result.policy.graph)}\n\n{summary}"


def _rows(result: PolicyResult) -> Labelled:
    why = f" ({STOPS[result.stopped]})" if result.policy is not None and result.stopped is not None else ""
    rows = [("status", _ending(result) + why)]
    if result.policy is None:
        if result.most_success is not None and result.most_success < 1 - ROUNDING:
            most = f"done with probability {likely(result.most_success)}, as far as is known"
            rows.append(("best chance", most))
        return rows
    done = likely(result.policy.success_probability, result.policy.failure_probability)
    if isinstance(result.objective, Success):
        rows.append(("value", f"done with probability {done}"))
    else:
        rows.append(("value", f"{with_unit(result.value, result.objective.unit)} of '{result.objective}'"))
        rows.append(("done", f"with probability {done}"))
    rows.append(("expected cost", number(result.expected_cost)))
    if result.looking is not None:
        rows.append(("looking", _looking(result.looking)))
    rows.append(("validated", result.validated or "no: the run ended before the policy was checked"))
    return [*rows, *_bound_rows(result)]


def _ending(result: PolicyResult) -> str:
    if result.status is Status.UNSOLVABLE:
        return f"unsolvable: {result.reason or 'it is proven that this problem has no policy'}"
    if result.status is Status.GAVE_UP and result.reason:
        return f"exhausted: {result.reason}"
    if result.status is not Status.OPTIMAL:
        return ENDINGS[result.status] + (f": {result.reason}" if result.reason else "")
    better = "is more likely to be done" if isinstance(result.objective, Success) else "has a lower value"
    return f"optimal: no policy of this problem {better}"


def _by(result: PolicyResult) -> str:
    if result.settings.attitude is None:
        return f"by '{result.objective}'"
    alpha = "" if result.settings.alpha is None else f" with alpha {number(result.settings.alpha)}"
    return f"for a risk-{result.settings.attitude} agent{alpha}"


def _looking(looking: Looking) -> str:
    """Return what it is worth to look at what was spent, in words."""
    best = "the best plan, which does not look at what was spent," if looking.proven else "the best plan found"
    value = number(looking.plan.value)
    if looking.worth <= ROUNDING * max(1.0, abs(looking.plan.value)):
        return f"is worth nothing: {best} has the same value, {value}"
    return f"is worth {number(looking.worth)}: {best} has value {value}"


def _bound_rows(result: PolicyResult) -> Labelled:
    bound = result.upper_bound if isinstance(result.objective, Success) else result.lower_bound
    if bound is None:
        return [("proven", "nothing")] if result.status is not Status.OPTIMAL else []
    if result.status is Status.OPTIMAL:
        return [("proven", f"to within {result.gap:.1g} of the value")] if result.gap else []
    if isinstance(result.objective, Success):
        return [("proven", f"no policy is done with a probability above {likely(bound)} (gap {result.gap:.4g})")]
    return [("proven", f"no policy has a value below {number(bound)} (gap {result.gap:.4g})")]
