"""What a search for several plans returns: the plans with their prices, and what is proven about them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, overload

from statehtn.counted import counted
from statehtn.display.top_plans import top_plans_html, top_plans_text
from statehtn.effort import Statistics
from statehtn.model.plan import Plan
from statehtn.model.status import Status
from statehtn.result import PricedStep
from statehtn.risk import Utility


@dataclass(frozen=True, slots=True, repr=False)
class RankedPlan:
    """One of the best plans.

    Args:
        rank: 1 for the best; of equally good ones the shorter comes first.
        is_proven: it is proven that only the plans before it are better.
        plan: the plan, with its decomposition.
        steps: its actions with their costs.
        utility: the agent's utility function.
        validated: whether it was checked independently of the search; a limit or an interruption may come first.
    """

    rank: int
    is_proven: bool
    plan: Plan
    steps: Sequence[PricedStep]
    utility: Utility
    validated: bool = True

    def __repr__(self) -> str:
        proven = "" if self.is_proven else ", not proven"
        return f"<plan {self.rank}: {counted(self.length, 'step')}, certainty equivalent {self.risk_cost:.10g}{proven}>"

    @property
    def length(self) -> int:
        """The number of its actions; those of the domain only."""
        return len(self.steps)

    @property
    def expected_cost(self) -> float:
        """Its expected cost, positive, in the domain's unit."""
        return math.fsum(step.expected_cost for step in self.steps)

    @property
    def risk_cost(self) -> float:
        """Its certainty-equivalent cost, positive, in the domain's unit; plans are ranked by it."""
        return math.fsum(step.risk_cost for step in self.steps)

    @property
    def expected_utility(self) -> str:
        """Its expected utility as a decimal number of any size."""
        return self.utility.expected_utility_text(self.risk_cost)

    @property
    def log10_expected_utility(self) -> float | None:
        """The paper's column: `log10 EU` of a seeking agent, `-log10 |EU|` of an averse one, None of a neutral one."""
        return self.utility.log10_expected_utility(self.risk_cost)

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of `plans` in the JSON object."""
        return {
            "rank": self.rank,
            "proven": self.is_proven,
            "validated": self.validated,
            "plan": [step.to_dict() for step in self.steps],
            "length": self.length,
            "expected_cost": self.expected_cost,
            "risk_cost": self.risk_cost,
            "expected_utility": self.expected_utility,
            "log10_expected_utility": self.log10_expected_utility,
        }


@dataclass(frozen=True, slots=True, repr=False)
class TopPlans(Sequence[RankedPlan]):
    """The best plans, the best first: a sequence of `RankedPlan`, with what is known about it.

    Args:
        status: `OPTIMAL`: the best k plans, or all where there are no k; `SOLVED`: a limit ended the search, what was
            found is there; `UNSOLVABLE`: it is proven that there is no plan; else what ended it without a plan.
        stopped: what ended the search before it was done, if anything did.
        k: how many plans were wanted.
        distinct: `sequence` or `multiset`: when two plans are different.
        problem_class: the paper's RA-parameters of what was solved, such as `PS10110`.
        utility: the agent's utility function.
        heuristic: the name of the heuristic.
        plans: the plans.
        is_all: it is proven that there are no other plans.
        lower_bound: no plan that is not among them has a lower risk cost, in the domain's unit; None where there is
            none, or nothing is known.
        statistics: the effort.
    """

    status: Status
    stopped: Status | None
    k: int
    distinct: str
    problem_class: str
    utility: Utility
    heuristic: str
    plans: tuple[RankedPlan, ...] = ()
    is_all: bool = False
    lower_bound: float | None = None
    statistics: Statistics = field(default_factory=Statistics)

    def __len__(self) -> int:
        return len(self.plans)

    def __repr__(self) -> str:
        agent = self.attitude if self.alpha is None else f"{self.attitude} {self.alpha:g}"
        return f"<{counted(len(self.plans), 'plan')} for {agent}: {self.status}, {self.proven} proven>"

    @overload
    def __getitem__(self, index: int) -> RankedPlan: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[RankedPlan, ...]: ...
    def __getitem__(self, index: int | slice) -> RankedPlan | tuple[RankedPlan, ...]:
        return self.plans[index]

    @property
    def attitude(self) -> str:
        """The agent's attitude: neutral, averse or seeking."""
        return str(self.utility.attitude)

    @property
    def alpha(self) -> float | None:
        """The curving coefficient of the exponential utility, per unit of cost; None for neutral."""
        return self.utility.alpha

    @property
    def proven(self) -> int:
        """How many plans, counted from the first, are proven to be the best."""
        return sum(ranked.is_proven for ranked in self.plans)

    def to_dict(self) -> dict[str, Any]:
        """Return the object that `statehtn top --json` prints."""
        return {
            "status": self.status.value,
            "stopped": None if self.stopped is None else self.stopped.value,
            "k": self.k,
            "distinct": self.distinct,
            "problem_class": self.problem_class,
            "heuristic": self.heuristic,
            "attitude": self.attitude,
            "alpha": self.alpha,
            "plans": [ranked.to_dict() for ranked in self.plans],
            "proven": self.proven,
            "all": self.is_all,
            "lower_bound": self.lower_bound,
            "statistics": asdict(self.statistics),
        }

    def __str__(self) -> str:
        return top_plans_text(self)

    def _repr_html_(self) -> str:
        return top_plans_html(self)
