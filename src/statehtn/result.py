"""What a planning run returns: the plan with its price, what is proven about it, and the effort."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from statehtn.correlation import Correlation, ScenarioLaw, scenario_laws
from statehtn.counted import counted
from statehtn.effort import Statistics
from statehtn.found_plan import PRICES, FoundPlan, Kept, PricedSteps
from statehtn.model.plan import Plan
from statehtn.model.status import Status
from statehtn.risk import Objective, Utility, agent_in, agent_name
from statehtn.settings import Settings, TopSettings

S = TypeVar("S", Settings, TopSettings)


@dataclass(frozen=True, slots=True, repr=False)
class RunResult(Generic[S]):
    """How a run of the planner ended, by what it compared plans, and what it has cost.

    Args:
        status: how it ended.
        settings: what was asked for.
        statistics: the effort.
        stopped: what ended it before it was done, with or without a plan; None for nothing.
        unread: whether a plan was found, better than what is there, that has too many tasks to be put together before
            that; of a search for several plans: whether there are more of them.
        largest: where no plan keeps all budgets, how well each can be kept by itself; else empty.
    """

    status: Status
    settings: S
    statistics: Statistics = field(default_factory=Statistics)
    stopped: Status | None = None
    unread: bool = False
    largest: tuple[Kept, ...] = ()

    @property
    def keep(self) -> tuple[Kept, ...]:
        """The budgets that plans have to keep; where none keeps all of them, how well each can be kept by itself."""
        return _asked(self)

    @property
    def objective(self) -> Objective:
        """What plans are compared by."""
        return self.settings.objective

    @property
    def value_unit(self) -> str:
        """The unit of the objective's values: `cost`, `probability` or `utility` (minus the expected utility)."""
        return str(self.objective.unit)

    @property
    def utility(self) -> Utility | None:
        """The utility function of a neutral, averse or seeking agent; None for any other objective."""
        return agent_in(self.objective)

    @property
    def attitude(self) -> str | None:
        """The agent's attitude: neutral, averse or seeking; None for any other objective."""
        return None if self.utility is None else str(self.utility.attitude)

    @property
    def alpha(self) -> float | None:
        """The curving coefficient of the exponential utility, per unit of cost; None for any other objective."""
        return None if self.utility is None else self.utility.alpha

    @property
    def problem_class(self) -> str | None:
        """The paper's RA-parameters of what was solved, such as `PS10110`; None where the paper has no such class."""
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
        largest: where no plan keeps all budgets, how well each can be kept by itself; else empty.
        found: the best plan found, and what it is worth; `plan`, `steps` and the prices below are its own. A limit or
            an interruption may come before it is validated: then the status is `solved`, and the prices are those of
            the search.
        bound: a lower bound on the value of every plan of the problem, in the objective's unit.
        correlation: where costs hang together and the plan is proven to be the best: what it is worth to know that;
            None for a neutral agent, to whom it is worth nothing.
    """

    found: FoundPlan | None = None
    bound: float | None = None
    correlation: Correlation | None = None

    def __repr__(self) -> str:
        plan = "no plan"
        if self.found is not None:
            what = "value" if self.utility is None else "certainty equivalent"
            plan = f"{counted(self.found.length, 'step')}, {what} {self.found.value:.10g}"
        return f"<result for {agent_name(self.objective)}: {self.status}, {plan}>"

    def __bool__(self) -> bool:
        """Tell whether there is a plan."""
        return self.found is not None

    @property
    def problem_class(self) -> str | None:
        """The paper's RA-parameters of what was solved, such as `PS10110`; None where the paper has no such class."""
        return class_counted_on(self.settings.problem_class, [] if self.found is None else [self.found.plan])

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
    def value(self) -> float | None:
        """What the plan is worth by the objective, in its unit; the search minimises it."""
        return None if self.found is None else self.found.value

    @property
    def risk_cost(self) -> float | None:
        """The certain cost that has the plan's value, positive, in the domain's unit: its certainty equivalent.

        None where no cost has it, as for a probability.
        """
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
        """No plan of the problem has a value below this; it is at most the value of the plan that was found."""
        if self.bound is None or not math.isfinite(self.bound):
            return None
        return self.bound if self.found is None else min(self.bound, self.found.value)

    @property
    def scenarios(self) -> tuple[ScenarioLaw, ...]:
        """What the plan costs in each scenario; empty where there is no plan, or none of its costs depends on them."""
        return () if self.found is None else scenario_laws(self.found.plan)

    @property
    def gap(self) -> float | None:
        """By how much the value of the plan may exceed that of the best one, in the objective's unit."""
        return None if self.found is None or self.lower_bound is None else self.found.value - self.lower_bound

    @property
    def keep(self) -> tuple[Kept, ...]:
        """The budgets that plans have to keep, and how well this one does.

        Where it is proven that no plan keeps all of them: how well each can be kept by itself.
        """
        return _asked(self) if self.found is None else self.found.keep

    def to_dict(self) -> dict[str, Any]:
        """Return the object that `statehtn plan --json` prints."""
        found = dict.fromkeys(PRICES) if self.found is None else self.found.to_dict()
        return {
            "status": self.status.value,
            "problem_class": self.problem_class,
            "solver": self.solver,
            "heuristic": self.heuristic,
            "objective": str(self.objective),
            "attitude": self.attitude,
            "alpha": self.alpha,
            **found,
            "value_unit": self.value_unit,
            "lower_bound": self.lower_bound,
            "gap": self.gap,
            "keep": [one.to_dict() for one in self.keep],
            "scenarios": [one.to_dict() for one in self.scenarios],
            "correlation": None if self.correlation is None else self.correlation.to_dict(),
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


def class_counted_on(name: str | None, plans: Sequence[Plan]) -> str | None:
    """Return the RA-parameters of a run whose plans may count on one of several outcomes of actions."""
    if name is None or not any(plan.outcomes is not None for plan in plans):
        return name
    return f"{name[:2]}n{name[3:]}"


def _asked(result: RunResult[Any]) -> tuple[Kept, ...]:
    """Return the budgets to keep of a run, with how well each can be kept by itself where that was asked."""
    return result.largest or tuple(Kept(one.budget, one.probability, None) for one in result.settings.keep)
