"""All states and networks of a ground problem that can be reached, with the decisions in each, from the core."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

import statehtn._relax as _relax
from statehtn.core.grounding import STOPPED, Grounding
from statehtn.core.policy_laws import BranchLaws
from statehtn.core.policy_problem import free_actions, uncertain_costs
from statehtn.errors import UnsupportedError
from statehtn.limits import Limits, ending_by
from statehtn.model.cost.law import CostLaw

MOST_NODES = 1_000_000
Edge = tuple[Fraction, CostLaw, int]
"""What may come of a decision: its probability, the law of its cost, the node that it leads to."""


@dataclass(frozen=True, slots=True)
class PolicySpace:
    """A Markov decision process: node 0 is where it begins.

    Args:
        choices: for each node its decisions, each with what may come of it.
        done: for each node whether nothing is left to do there.
    """

    choices: list[list[list[Edge]]]
    done: list[bool]


def policy_space(grounding: Grounding, limits: Limits = Limits()) -> PolicySpace:
    """Return all that can be reached, for agents that see what comes of actions, and what they cost.

    Args:
        grounding: the ground problem; its methods are whole.
        limits: they hold.

    Raises:
        LimitReached: a limit was reached.
        UnsupportedError: there are too many nodes; there may be infinitely many.
    """
    if not grounding.handle.solvable:  # nothing is left of the initial network
        return PolicySpace([[]], [False])
    space = _explored(grounding, limits, "too many to be written; export the best policy instead (--policy)")
    laws = BranchLaws(grounding)
    choices: list[list[list[Edge]]] = []
    for node in range(space.node_count):
        limits.check()
        choices.append(
            [
                [
                    (
                        Fraction(1) if action is None else grounding.probabilities[action],
                        laws.of((action, tuple(due))),
                        other,
                    )
                    for other, action, due in outcomes
                ]
                for _, _, outcomes in space.decisions(node)
            ]
        )
    return PolicySpace(choices, [not space.tasks(node) for node in range(space.node_count)])


def most_cost(grounding: Grounding, steps_of: Callable[[CostLaw], float], limits: Limits) -> float | None:
    """Return the largest total cost of a run, whatever is decided and whatever comes; None where there is no largest.

    Args:
        grounding: the ground problem; its methods are whole.
        steps_of: the largest cost of a law.
        limits: they hold.

    Raises:
        LimitReached: a limit was reached.
        UnsupportedError: there are too many nodes; there may be infinitely many.
    """
    space = _explored(grounding, limits, "too many to find out how much a run may cost at most")
    return space.most_cost(list(map(steps_of, grounding.laws)), list(map(steps_of, grounding.part_laws)))


def _explored(grounding: Grounding, limits: Limits, too_many: str) -> _relax.PolicySpace:
    seconds, memory_bytes, steps = limits.left()
    space = _relax.PolicySpace(
        grounding.handle,
        free_actions(grounding),
        *uncertain_costs(grounding),
        most_nodes=MOST_NODES,
        seconds=seconds,
        memory_bytes=memory_bytes,
        steps=steps,
    )
    if space.stop is not None:
        raise ending_by(STOPPED[space.stop])
    if space.expanded_count < space.node_count:
        raise UnsupportedError(
            f"more than {MOST_NODES} states with their networks can be reached, perhaps infinitely many, {too_many}"
        )
    return space
