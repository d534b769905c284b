"""The Markov decision process of all that can be reached."""

from __future__ import annotations

from statehtn.core.grounding import Grounding
from statehtn.core.policy_space import policy_space
from statehtn.counted import finite
from statehtn.limits import Limits
from statehtn.policies.prism import Edge, MarkovModel


def reachable_model(grounding: Grounding, failure: float | None, limits: Limits) -> MarkovModel:
    """Return the decisions in every state with every network that can be reached.

    Args:
        grounding: the ground problem; its methods are whole.
        failure: what giving up costs; None, or infinite, where the agent cannot.
        limits: they hold.

    Raises:
        LimitReached: a limit was reached.
        UnsupportedError: there are too many of them.
    """
    space = policy_space(grounding, limits)
    choices = [
        [[Edge(p, law, other) for p, law, other in edges if p > 0] for edges in decisions]
        for decisions in space.choices
    ]
    return MarkovModel(choices, space.done, finite(failure))
