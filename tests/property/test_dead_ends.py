"""Where a dead end is said to prove that there is no plan, there is none."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

import statehtn
from statehtn.hddl.dead_ends import dead_ends
from statehtn.model import Effect, Problem
from tests.strategies import problems


def without(problem: Problem, predicates: set[str]) -> Problem:
    """A problem in which nothing makes facts of some predicates true."""

    def kept(effect: Effect) -> bool:
        return not effect.positive or effect.atom.predicate not in predicates

    domain = problem.domain
    actions = {
        name: replace(action, effects=tuple(filter(kept, action.effects))) for name, action in domain.actions.items()
    }
    facts = frozenset(fact for fact in problem.initial_state if fact[0] not in predicates)
    return replace(problem, domain=replace(domain, actions=actions), initial_state=facts)


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(problems(), st.sets(st.sampled_from(("p0", "p1", "p2", "p3")), min_size=2))
def test_a_proof_is_one(problem: Problem, predicates: set[str]) -> None:
    changed = without(problem, predicates)
    if any(found.is_proof for found in dead_ends(changed)):
        result = statehtn.plan(changed, search="greedy", time_limit=20)
        event(result.status.value)
        assert result.plan is None
