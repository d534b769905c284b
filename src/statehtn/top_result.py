"""What a search for several plans returns: the plans with their prices, and what is proven about them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, overload

from statehtn.counted import counted
from statehtn.found_plan import FoundPlan
from statehtn.result import RunResult, class_counted_on
from statehtn.risk import agent_in, agent_name
from statehtn.settings import TopSettings


@dataclass(frozen=True, slots=True, repr=False)
class RankedPlan(FoundPlan):
    """One of the best plans.

    Args:
        plan: the plan, with its decomposition.
        steps: its actions with their costs.
        objective: what plans are compared by.
        unchecked: what ended its validation before it had come to its end; None where the plan is valid.
        value: what it is worth by the objective, in the objective's unit.
        risk_cost: the certain cost that has this value; None where none has.
        keep: the budgets that it has to keep.
        rank: 1 for the best; of equally good ones the shorter comes first.
        is_proven: it is proven that only the plans before it are better.
    """

    rank: int
    is_proven: bool

    def __repr__(self) -> str:
        proven = "" if self.is_proven else ", not proven"
        what = "value" if agent_in(self.objective) is None else "certainty equivalent"
        return f"<plan {self.rank}: {counted(self.length, 'step')}, {what} {self.value:.10g}{proven}>"

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of `plans` in the JSON object."""
        found = FoundPlan.to_dict(self)
        kept = [one.to_dict() for one in self.keep]
        return {"rank": self.rank, "proven": self.is_proven, "validated": self.validated, **found, "keep": kept}


@dataclass(frozen=True, slots=True, repr=False)
class TopPlans(RunResult[TopSettings], Sequence[RankedPlan]):
    """The best plans, the best first: a sequence of `RankedPlan`, with what is known about it.

    Args:
        status: `OPTIMAL`: the best k plans, or all where there are no k; `SOLVED`: a limit ended the search, what was
            found is there; `UNSOLVABLE`: it is proven that there is no plan; else what ended it without a plan.
        settings: what was asked for.
        statistics: the effort.
        stopped: what ended the search before it was done, if anything did.
        unread: whether more plans were found that could not be put together before that.
        largest: where no plan keeps all budgets, how well each can be kept by itself; else empty.
        plans: the plans.
        is_all: it is proven that there are no other plans.
        lower_bound: no plan that is not among them has a lower value, in the objective's unit; None where there is
            none, or nothing is known.
    """

    plans: tuple[RankedPlan, ...] = ()
    is_all: bool = False
    lower_bound: float | None = None

    def __len__(self) -> int:
        return len(self.plans)

    def __repr__(self) -> str:
        agent = agent_name(self.objective)
        return f"<{counted(len(self.plans), 'plan')} for {agent}: {self.status}, {self.proven} proven>"

    @overload
    def __getitem__(self, index: int) -> RankedPlan: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[RankedPlan, ...]: ...
    def __getitem__(self, index: int | slice) -> RankedPlan | tuple[RankedPlan, ...]:
        return self.plans[index]

    @property
    def problem_class(self) -> str | None:
        """The paper's RA-parameters of what was solved, such as `PS10110`; None where the paper has no such class."""
        return class_counted_on(self.settings.problem_class, [ranked.plan for ranked in self.plans])

    @property
    def k(self) -> int:
        """How many plans were wanted."""
        return self.settings.k

    @property
    def distinct(self) -> str:
        """When two plans are different: `sequence` or `multiset`."""
        return self.settings.distinct

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
            "objective": str(self.objective),
            "value_unit": self.value_unit,
            "attitude": self.attitude,
            "alpha": self.alpha,
            "plans": [ranked.to_dict() for ranked in self.plans],
            "proven": self.proven,
            "all": self.is_all,
            "lower_bound": self.lower_bound,
            "keep": [one.to_dict() for one in self.keep],
            "unread": self.unread,
            "statistics": self.statistics.to_dict(),
        }

    def __str__(self) -> str:
        from statehtn.display.top_plans import top_plans_text

        return top_plans_text(self)

    def _repr_html_(self) -> str:
        from statehtn.display.top_plans import top_plans_html

        return top_plans_html(self)
