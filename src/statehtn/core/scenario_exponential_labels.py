"""Labels of a disutility of exponentials where costs hang together: a sum for each of them in each scenario."""

from __future__ import annotations

import math

from statehtn.core.exponential_labels import ExponentialLabels, exponential_agent
from statehtn.core.finite_labels import FiniteLabels
from statehtn.core.grounding import Grounding
from statehtn.core.pricing import price
from statehtn.core.scenarios import given_scenarios
from statehtn.core.switches import LabelSwitches
from statehtn.limits import Limits
from statehtn.risk import Exponential, Exponentials, Neutral, OneSwitch
from statehtn.risk.disutility import Term


class ScenarioExponentialLabels(ExponentialLabels):
    """Labels of the certainty equivalent of such a disutility, over all scenarios.

    Given scenario k, of probability p_k, costs are independent, so that the exponential mean K_k of a plan is the sum
    of those of its actions. Over all scenarios the mean of an exponential of the total cost is the sum of
    `p_k e^(slope K_k)`: that of one exponential for each scenario, of equal slopes. Means add up as ever.

    Args:
        grounding: the ground problem, in which costs hang together.
        objective: an exponential agent, or one whose disutility has several such terms.
        switches: refinements to leave out.
        limits: they hold while actions are priced.

    Raises:
        InputError: a cost has no finite price; the message names the action.
        LimitReached: a limit was reached.
    """

    def __init__(
        self,
        grounding: Grounding,
        objective: Exponential | OneSwitch | Exponentials,
        switches: LabelSwitches,
        limits: Limits,
    ) -> None:
        given = given_scenarios(grounding)
        terms: tuple[Term, ...]
        if isinstance(objective, Exponential):
            self._linear, terms = 0.0, (Term(objective.slope, 0.0),)
        else:
            self._linear, terms = objective.linear, objective.terms
        self._terms = tuple(
            Term(term.slope, term.log_weight + math.log(scenario.probability)) for term in terms for scenario in given
        )
        problems = [price(grounding, Neutral(), limits)] if self._linear > 0 else []
        problems += [
            price(scenario.grounding, exponential_agent(term.slope), limits) for term in terms for scenario in given
        ]
        self._is_convex = all(term.slope > 0 for term in terms)
        FiniteLabels.__init__(self, grounding, objective, problems, switches, self._is_convex)
