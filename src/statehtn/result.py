"""What a planning run returns: the plan with its price, what is proven about it, and the effort."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from statehtn.counted import counted
from statehtn.effort import Statistics
from statehtn.found_plan import PRICES, FoundPlan, PricedSteps
from statehtn.model.plan import Plan
from statehtn.model.status import Status
from statehtn.risk import Utility, agent_name
from statehtn.settings import Settings, TopSettings

S = TypeVar("S", Settings, TopSettings)


@dataclass(frozen=True, slots=True, repr=False)
class RunResult(Generic[S]):
    """How a run of the planner ended, for whom it planned, and what it has cost.

    Args:
        status: how it ended.
        settings: what was asked for.
        statistics: the effort.
        stopped: what ended it before it was done, with or without a plan; None for nothing.
        unread: whether a plan was found, better than what is there, that has too many tasks to be put together before
            that; of a search for several plans: whether there are more of them.
    """

    status: Status
    settings: S
    statistics: Statistics = field(default_factory=Statistics)
    stopped: Status | None = None
    unread: bool = False

    @property
    def utility(self) -> Utility:
        """The agent's utility function."""
        return self.settings.objective

    @property
    def attitude(self) -> str:
        """The agent's attitude: neutral, averse or seeking."""
        return str(self.utility.attitude)

    @property
    def alpha(self) -> float | None:
        """The curving coefficient of the exponential utility, per unit of cost; None for neutral."""
        return self.utility.alpha

    @property
    def problem_class(self) -> str:
        """The paper's RA-parameters of what was solved, such as `PS10110`."""
        return self.settings.problem_class

    @property
    def heuristic(self) -> str:
        """The name of the heuristic."""
        return self.settings.heuristic


@dataclass(frozen=True, slots=True, repr=False)
class Result(RunResult[Settings]):
    """The result of a planning run; what is not known is None.

    Args:
        status: how the run ended.
        settings: what was asked for.
        statistics: the effort.
        stopped: what ended the run before it was done, with or without a plan: a limit or an interruption; None for
            nothing.
        unread: whether a plan was found, better than what is there, that has too many tasks to be put together before
            that.
        found: the best plan found, and what it is worth; `plan`, `steps` and the prices below are its own. A limit or
            an interruption may come before it is validated: then the status is `solved`, and the prices are those of
            the search.
        bound: a lower bound on the risk cost of every plan of the problem, in the domain's unit.
    """

    found: FoundPlan | None = None
    bound: float | None = None

    def __repr__(self) -> str:
        plan = "no plan"
        if self.found is not None:
            plan = f"{counted(self.found.length, 'step')}, certainty equivalent {self.found.risk_cost:.10g}"
        return f"<result for {agent_name(self.utility)}: {self.status}, {plan}>"

    def __bool__(self) -> bool:
        """Tell whether there is a plan."""
        return self.found is not None

    @property
    def solver(self) -> str:
        """The name of the solver."""
        return self.settings.solver

    @property
    def plan(self) -> Plan | None:
        """The best plan found, with its decomposition."""
        return None if self.found is None else self.found.plan

    @property
    def steps(self) -> PricedSteps:
        """The plan's actions with their costs; empty where there is no plan."""
        return PricedSteps() if self.found is None else self.found.steps

    @property
    def validated(self) -> bool:
        """Whether the plan was checked independently of the search; false, too, where there is none."""
        return self.found is not None and self.found.validated

    @property
    def length(self) -> int | None:
        """The number of the plan's actions; those of the domain only."""
        return None if self.found is None else self.found.length

    @property
    def expected_cost(self) -> float | None:
        """The plan's expected cost, positive, in the domain's unit."""
        return None if self.found is None else self.found.expected_cost

    @property
    def risk_cost(self) -> float | None:
        """The plan's certainty-equivalent cost, positive, in the domain's unit; the search minimises it."""
        return None if self.found is None else self.found.risk_cost

    @property
    def expected_utility(self) -> str | None:
        """The plan's expected utility as a decimal number of any size."""
        return None if self.found is None else self.found.expected_utility

    @property
    def log10_expected_utility(self) -> float | None:
        """The paper's column: `log10 EU` of a seeking agent, `-log10 |EU|` of an averse one, None of a neutral one."""
        return None if self.found is None else self.found.log10_expected_utility

    @property
    def lower_bound(self) -> float | None:
        """No plan of the problem has a risk cost below this; at most the risk cost of the plan that was found."""
        if self.bound is None or not math.isfinite(self.bound):
            return None
        return self.bound if self.found is None else min(self.bound, self.found.risk_cost)

    def to_dict(self) -> dict[str, Any]:
        """Return the object that `statehtn plan --json` prints."""
        found = dict.fromkeys(PRICES) if self.found is None else self.found.to_dict()
        return {
            "status": self.status.value,
            "problem_class": self.problem_class,
            "solver": self.solver,
            "heuristic": self.heuristic,
            "attitude": self.attitude,
            "alpha": self.alpha,
            **found,
            "lower_bound": self.lower_bound,
            "validated": None if self.found is None else self.validated,
            "stopped": None if self.stopped is None else self.stopped.value,
            "unread": self.unread,
            "statistics": self.statistics.to_dict(),
        }

    def __str__(self) -> str:
        from statehtn.display.result import result_text

        return result_text(self)

    def _repr_html_(self) -> str:
        from statehtn.display.result import result_html

        return result_html(self)
