"""The expected utility of a plan: by segments, as the planner uses it, and by trajectories, as it is defined."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence

from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.scenario_cost import ScenarioCost, sum_of
from statehtn.risk.neutral import Neutral
from statehtn.risk.objective import AdditiveObjective, Objective
from statehtn.risk.utility import DIGITS, Utility


def plan_risk_cost(laws: Iterable[CostLaw], objective: AdditiveObjective) -> float:
    """Return the certainty-equivalent cost of a plan: the sum of those of its actions, positive, in the domain's unit.

    Where costs hang together, it is that of their sum.

    Source: the logarithm of the paper's equation 5 (Theorem 1), or its equation 7 for the neutral attitude.
    """
    laws = list(laws)
    if not adds_up(objective, laws):
        return objective.risk_cost(sum_of(laws))
    return math.fsum(objective.risk_cost(law) for law in laws)


def adds_up(objective: Objective, laws: Iterable[CostLaw]) -> bool:
    """Tell whether the value of the sum of these costs is the sum of a price for each of them.

    Where costs hang together only their means add up.
    """
    if isinstance(objective, Neutral):
        return True
    return isinstance(objective, AdditiveObjective) and not any(isinstance(law, ScenarioCost) for law in laws)


def plan_expected_cost(laws: Iterable[CostLaw]) -> float:
    """Return the expected cost of a plan, positive, in the domain's unit."""
    return plan_risk_cost(laws, Neutral())


def expected_utility(laws: Iterable[CostLaw], utility: Utility) -> float:
    """Return the expected utility of a plan; infinite or 0 where a float cannot hold it."""
    return utility.utility(plan_risk_cost(laws, utility))


def expected_utility_text(laws: Iterable[CostLaw], utility: Utility, digits: int = DIGITS) -> str:
    """Return the expected utility of a plan as a decimal number of any size."""
    return utility.expected_utility_text(plan_risk_cost(laws, utility), digits)


def expected_utility_by_trajectories(laws: Sequence[CostDistribution], utility: Utility) -> float:
    """Return the expected utility of a plan as the sum over all its trajectories; exponential in its length.

    A trajectory is one outcome of every action. This is the definition (paper equation 4) and the oracle for the other
    functions, for plans whose utility a float can hold.
    """
    return math.fsum(
        math.prod(probability for probability, _ in trajectory)
        * utility.utility(math.fsum(cost for _, cost in trajectory))
        for trajectory in itertools.product(*(law.outcomes for law in laws))
    )


def paper_value(utility: Utility, law: CostLaw) -> float:
    """Return the value that the paper gives a primitive task (Algorithm 1, lines 3 and 5): not positive, maximised.

    It is the expected utility for the neutral agent, and `a log10(a alpha EU)` for the others (equation 10, with the
    sign that it needs): the risk cost's negative, in another unit.
    """
    return -utility.risk_cost(law) * paper_unit(utility)


def paper_unit(utility: Utility) -> float:
    """Return how much a risk cost of 1 is in the paper's values."""
    return 1.0 if utility.alpha is None else utility.alpha / math.log(10)
