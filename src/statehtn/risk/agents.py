"""Agents by the attitudes that the paper knows: their utilities from what users give, their names, their order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from statehtn.errors import UsageError
from statehtn.expected import number, one_of
from statehtn.risk.exponential import Exponential
from statehtn.risk.neutral import Neutral
from statehtn.risk.objective import Objective
from statehtn.risk.utility import Attitude, AttitudeName, Utility


def _neutral(alpha: float | None) -> Utility:
    if alpha is not None:
        raise UsageError(
            f"the neutral attitude takes no alpha, found {alpha:g}; leave alpha out, or choose averse or seeking"
        )
    return Neutral()


def _exponential(attitude: Attitude) -> Callable[[float | None], Utility]:
    def make(alpha: float | None) -> Utility:
        if alpha is None:
            raise UsageError(f"the {attitude} attitude needs alpha, a positive number per unit of cost (such as 0.5)")
        return Exponential(attitude, alpha)

    return make


UTILITIES: Mapping[Attitude, Callable[[float | None], Utility]] = {
    Attitude.NEUTRAL: _neutral,
    Attitude.AVERSE: _exponential(Attitude.AVERSE),
    Attitude.SEEKING: _exponential(Attitude.SEEKING),
}
"""For every attitude the function that makes its utility from alpha (None: not given)."""


def utility_for(attitude: Attitude | AttitudeName, alpha: float | None = None) -> Utility:
    """Return the utility of an attitude.

    Args:
        attitude: neutral, averse or seeking.
        alpha: the curving coefficient, positive, per unit of cost; None for neutral.

    Raises:
        UsageError: there is no such attitude; alpha is missing for averse or seeking, given for neutral, or not a
            positive finite number.
    """
    make = UTILITIES[Attitude(one_of(attitude, UTILITIES, "attitude"))]
    return make(None if alpha is None else number(alpha, "alpha"))


def agents_of(attitudes: Iterable[Attitude | AttitudeName], alphas: Iterable[float]) -> tuple[Utility, ...]:
    """Combine attitudes with alphas; a neutral agent has none, the others each of them.

    Raises:
        UsageError: there is no such attitude, or an alpha is not a positive finite number.
    """
    given = list(alphas)
    return tuple(
        utility_for(attitude, alpha)
        for attitude in attitudes
        for alpha in ([None] if attitude == Attitude.NEUTRAL else given)
    )


def agent_in(objective: Objective) -> Utility | None:
    """Return the agent that the paper knows whose objective this is: neutral, averse or seeking; None for another."""
    return objective if isinstance(objective, Neutral | Exponential) else None


def agent_order(agent: Utility) -> tuple[float, str]:
    """Return what agents are sorted by: from the most averse over the neutral to the most seeking."""
    sign = {Attitude.AVERSE: -1.0, Attitude.SEEKING: 1.0}.get(agent.attitude, 0.0)
    return sign * (agent.alpha or 0.0), str(agent.attitude)


def agent_name(objective: Objective) -> str:
    """Return what an objective is called among others, such as `neutral`, `averse 0.9` or `cvar 0.95`."""
    agent = agent_in(objective)
    if agent is None:
        return str(objective)
    return str(agent.attitude) if agent.alpha is None else f"{agent.attitude} {agent.alpha:g}"
