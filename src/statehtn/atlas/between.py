"""What is known for deadlines and for amounts of wealth between those that were asked for.

The best plan of the page is a plan, so that its value is an upper bound. Lower bounds follow from the answers on both
sides, without another search:

- the least probability to miss a deadline does not rise with the deadline, so that it is at least that of the next
  answer;
- the disutility of a one-switch agent, `C + s e^(A C)` with `s = (D/A) e^(-A W)`, is linear in `s` for each plan. So
  the least one is concave in `s`, and at least what lies on the chord between two answers. Where one plan is the best
  for both, it is the best between them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise

from statehtn.atlas.survey import Atlas, Choice
from statehtn.errors import StateHtnError
from statehtn.risk import Deadline, Objective, OneSwitch

HALVINGS = 80
LARGEST_EXPONENT = 600.0


def all_deadlines(atlas: Atlas, steps: int) -> list[Choice]:
    """Return the answers for deadlines, and what is known at so many places between two of them."""

    def lower(left: Choice, right: Choice, at: float) -> float | None:  # noqa: ARG001
        return _least(right)

    return _filled(atlas, atlas.deadlines, steps, Deadline, lower)


def all_wealths(atlas: Atlas, steps: int) -> list[Choice]:
    """Return the answers for amounts of wealth, and what is known at so many places between two of them."""
    alpha, tradeoff = atlas.one_switch

    def weight(wealth: float) -> float:
        return tradeoff / alpha * math.exp(-alpha * wealth)

    def disutility(choice: Choice) -> float | None:
        least = _least(choice)
        if least is None or alpha * least > LARGEST_EXPONENT:
            return None
        return least + weight(choice.at) * math.exp(alpha * least)

    def lower(left: Choice, right: Choice, at: float) -> float | None:
        poor, rich = disutility(left), disutility(right)
        if poor is None or rich is None:
            return None
        share = (weight(at) - weight(right.at)) / (weight(left.at) - weight(right.at))
        return _equivalent(share * poor + (1 - share) * rich, weight(at), alpha)

    return _filled(atlas, atlas.wealths, steps, lambda at: OneSwitch(alpha, tradeoff, at), lower)


def _filled(
    atlas: Atlas,
    answers: Sequence[Choice],
    steps: int,
    objective: Callable[[float], Objective],
    lower: Callable[[Choice, Choice, float], float | None],
) -> list[Choice]:
    """Return answers with places between them, each with the best plan of the page and what no plan is better by."""

    def between(left: Choice, right: Choice) -> Iterator[Choice]:
        for step in range(1, steps + 1):
            at = left.at + (right.at - left.at) * step / (steps + 1)
            worth = _worth(atlas, objective(at))
            if not worth:
                continue
            value, plan = min(worth)
            least = lower(left, right, at)
            yield Choice(at, plan, value, None if least is None else max(0.0, value - least))

    found = list(answers[:1])
    for left, right in pairwise(answers):
        found += [*between(left, right), right]
    return found


def _worth(atlas: Atlas, objective: Objective) -> list[tuple[float, int]]:
    """Return what plans are worth by an objective, with their indices; without those of which that is not finite."""
    found = []
    for number, plan in enumerate(atlas.plans):
        try:
            found.append((objective.value(plan.total), number))
        except StateHtnError:
            continue
    return found


def _least(choice: Choice) -> float | None:
    """Return what no plan is better than, at least 0; None where nothing is known."""
    return None if choice.value is None or choice.gap is None else max(0.0, choice.value - choice.gap)


def _equivalent(disutility: float, weight: float, alpha: float) -> float:
    """Return the certain cost, at least 0, of a disutility `x + weight e^(alpha x)`: a bit less, never more."""
    low, high = 0.0, math.log(max(1.0, disutility / weight)) / alpha
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if middle + weight * math.exp(alpha * middle) <= disutility:
            low = middle
        else:
            high = middle
    return low
