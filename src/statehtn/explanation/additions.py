"""What a problem lacks: smallest sets of facts and objects with which all could be done if nothing were deleted."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from itertools import chain

from statehtn.explanation.reason import Addition, Reason
from statehtn.explanation.reasons import Reasoner
from statehtn.explanation.relaxation import relaxations
from statehtn.limits import LimitReached, Limits
from statehtn.model import Problem

MOST_SETS = 5
LARGEST_SET = 4
MOST_TRIALS = 120
Additions = frozenset[Addition]


def smallest_additions(problem: Problem, root: Reason, limits: Limits = Limits()) -> list[tuple[Addition, ...]]:
    """Return sets of additions with which the relaxation can be solved; none can be left out of any of them.

    Sets of few members come first. Candidates are what the reasons name; a set that helps in part is asked for its
    own reasons. So not every such set is found, but every set that is returned has been tried out.

    Args:
        problem: one whose relaxation cannot be solved.
        root: the reason for that.
        limits: where they are reached, what has been found so far is returned.
    """
    found: list[Additions] = []
    reasons: dict[Additions, Reason | None] = {frozenset(): root}

    def reason_with(chosen: Additions) -> Reason | None:
        """Return why the problem with additions cannot be solved; None if it can."""
        if chosen not in reasons:
            levels = relaxations(with_additions(problem, chosen), limits)
            reasons[chosen] = None if levels[-1].is_solvable else Reasoner(levels, limits).root()
        return reasons[chosen]

    def search() -> None:
        layer: list[Additions] = [frozenset()]
        for _ in range(LARGEST_SET):
            following: dict[Additions, None] = {}
            for chosen in layer:
                for addition in candidates(_certain(reason_with(chosen))):
                    wider = chosen | {addition}
                    if wider == chosen or wider in following or any(known <= wider for known in found):
                        continue
                    if len(reasons) > MOST_TRIALS or len(found) == MOST_SETS:
                        return
                    if reason_with(wider) is not None:
                        following[wider] = None
                    elif all(reason_with(wider - {each}) is not None for each in wider):
                        found.append(wider)
            layer = list(following)

    with suppress(LimitReached):
        search()
    return [_in_order(each) for each in found]


def _certain(reason: Reason | None) -> Reason:
    """Return the reason why a problem cannot be solved, of one that was found not to be solvable."""
    assert reason is not None
    return reason


def candidates(root: Reason) -> Iterator[Addition]:
    """Yield what could be added, once each: the additions of the roots first."""
    reasons = chain((reason for reason in root.walk() if not reason.children), root.walk())
    yield from dict.fromkeys(addition for reason in reasons for addition in reason.additions)


def with_additions(problem: Problem, additions: Additions) -> Problem:
    """Return the problem with more objects and facts; a fact about an object that is not there is left out."""
    added = {each.new_name: each.type for each in additions if each.type is not None}
    objects = {**problem.objects, **dict(sorted(added.items()))}
    there = {*problem.domain.constants, *objects}
    facts = {each.fact for each in additions if each.fact is not None and there.issuperset(each.fact[1:])}
    return replace(problem, objects=objects, initial_state=problem.initial_state | facts)


def _in_order(additions: Additions) -> tuple[Addition, ...]:
    return tuple(sorted(additions, key=lambda each: (each.fact is not None, str(each))))
