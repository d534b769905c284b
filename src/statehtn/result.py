"""What a planning run returns: the plan with its price, what is proven about it, and the effort."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from statehtn.counted import counted
from statehtn.display.law import brief
from statehtn.display.result import result_html, result_text, steps_html
from statehtn.effort import Statistics
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.plan import MOST_SHOWN, Plan, Step
from statehtn.model.status import Status
from statehtn.risk import Utility


@dataclass(frozen=True, slots=True, repr=False)
class PricedStep:
    """An action of a plan and what it costs in the state in which it is executed.

    Args:
        step: the ground action.
        law: the distribution of its cost.
        expected_cost: the mean of the distribution, positive, in the domain's unit.
        risk_cost: the certainty equivalent of the distribution for this agent, in the same unit.
    """

    step: Step
    law: CostLaw
    expected_cost: float
    risk_cost: float

    def __repr__(self) -> str:
        return f"<{self.step}: {brief(str(self.law))}; certainty equivalent {self.risk_cost:.6g}>"

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of `plan` in the JSON object.

        `outcomes` is null for a law that is no list of outcomes; `law` then says in words what it is.
        """
        entry = {
            "action": self.step.action,
            "arguments": list(self.step.arguments),
            "expected_cost": self.expected_cost,
            "risk_cost": self.risk_cost,
        }
        if isinstance(self.law, CostDistribution):
            return entry | {"outcomes": [list(outcome) for outcome in self.law.outcomes]}
        return entry | {"outcomes": None, "law": str(self.law)}


class PricedSteps(tuple[PricedStep, ...]):
    """The steps of a plan in the order of their execution: a tuple that shows itself in short."""

    __slots__ = ()

    def __repr__(self) -> str:
        shown = " ".join(str(priced.step) for priced in self[:MOST_SHOWN])
        return f"<{len(self)} priced steps{': ' if self else ''}{shown}{' ...' if len(self) > MOST_SHOWN else ''}>"

    def _repr_html_(self) -> str:
        return steps_html(self)


@dataclass(frozen=True, slots=True, repr=False)
class Result:
    """The result of a planning run; what is not known is None.

    Args:
        status: how the run ended.
        problem_class: the paper's RA-parameters of what was solved, such as `PS10110`.
        utility: the agent's utility function.
        solver: the name of the solver.
        heuristic: the name of the heuristic.
        plan: the best plan found, with its decomposition.
        steps: the plan's actions with their costs; empty where there is no plan.
        validated: whether the plan was checked independently of the search; false, too, where there is none. A limit
            or an interruption may come first: then the status is `solved`, and the prices are those of the search.
        bound: a lower bound on the risk cost of every plan of the problem, in the domain's unit.
        statistics: the effort.
        stopped: what ended the run before it was done, with or without a plan: a limit or an interruption; None for
            nothing.
    """

    status: Status
    problem_class: str
    utility: Utility
    solver: str
    heuristic: str
    plan: Plan | None = None
    steps: Sequence[PricedStep] = PricedSteps()
    validated: bool = False
    bound: float | None = None
    statistics: Statistics = field(default_factory=Statistics)
    stopped: Status | None = None

    def __repr__(self) -> str:
        agent = self.attitude if self.alpha is None else f"{self.attitude} {self.alpha:g}"
        plan = "no plan"
        if self.length is not None:
            plan = f"{counted(self.length, 'step')}, certainty equivalent {self.risk_cost:.10g}"
        return f"<result for {agent}: {self.status}, {plan}>"

    def __bool__(self) -> bool:
        """Tell whether there is a plan."""
        return self.plan is not None

    @property
    def attitude(self) -> str:
        """The agent's attitude: neutral, averse or seeking."""
        return str(self.utility.attitude)

    @property
    def alpha(self) -> float | None:
        """The curving coefficient of the exponential utility, per unit of cost; None for neutral."""
        return self.utility.alpha

    @property
    def length(self) -> int | None:
        """The number of the plan's actions; those of the domain only."""
        return None if self.plan is None else len(self.plan.steps)

    @property
    def expected_cost(self) -> float | None:
        """The plan's expected cost, positive, in the domain's unit."""
        return None if self.plan is None else math.fsum(step.expected_cost for step in self.steps)

    @property
    def risk_cost(self) -> float | None:
        """The plan's certainty-equivalent cost, positive, in the domain's unit; the search minimises it."""
        return None if self.plan is None else math.fsum(step.risk_cost for step in self.steps)

    @property
    def expected_utility(self) -> str | None:
        """The plan's expected utility as a decimal number of any size."""
        return None if self.risk_cost is None else self.utility.expected_utility_text(self.risk_cost)

    @property
    def log10_expected_utility(self) -> float | None:
        """The paper's column: `log10 EU` of a seeking agent, `-log10 |EU|` of an averse one, None of a neutral one."""
        return None if self.risk_cost is None else self.utility.log10_expected_utility(self.risk_cost)

    @property
    def lower_bound(self) -> float | None:
        """No plan of the problem has a risk cost below this; at most the risk cost of the plan that was found."""
        if self.bound is None or not math.isfinite(self.bound):
            return None
        return self.bound if self.risk_cost is None else min(self.bound, self.risk_cost)

    def to_dict(self) -> dict[str, Any]:
        """Return the object that `statehtn plan --json` prints."""
        return {
            "status": self.status.value,
            "problem_class": self.problem_class,
            "solver": self.solver,
            "heuristic": self.heuristic,
            "attitude": self.attitude,
            "alpha": self.alpha,
            "plan": None if self.plan is None else [step.to_dict() for step in self.steps],
            "length": self.length,
            "expected_cost": self.expected_cost,
            "risk_cost": self.risk_cost,
            "expected_utility": self.expected_utility,
            "log10_expected_utility": self.log10_expected_utility,
            "lower_bound": self.lower_bound,
            "validated": None if self.plan is None else self.validated,
            "stopped": None if self.stopped is None else self.stopped.value,
            "statistics": asdict(self.statistics),
        }

    def __str__(self) -> str:
        return result_text(self)

    def _repr_html_(self) -> str:
        return result_html(self)
