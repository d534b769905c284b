"""The probability of being done, as what policies are chosen by."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.risk.objective import ValueUnit


@dataclass(frozen=True, slots=True)
class Success:
    """The largest probability of being done; of policies with it, the one of least expected cost.

    The cost counts until the agent is done, or until that has become impossible. No law of a cost says how likely it is
    to be done, so that plans are not compared by it: a plan of actions with one outcome each is done for certain.
    Source: the criterion MAXPROB of Kolobov, Mausam, Weld and Geffner, *Heuristic search for generalized stochastic
    shortest path MDPs*, 2011.
    """

    unit = ValueUnit.PROBABILITY

    def __str__(self) -> str:
        return "success"
