"""What agents of several objectives do with one problem, where their plans part, and what each is worth to others."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Any

from statehtn.errors import UsageError
from statehtn.expected import items, number, one_of, whole_number
from statehtn.found_plan import PricedStep, value_of
from statehtn.model.cost.law import CostLaw
from statehtn.model.status import Status
from statehtn.result import Result
from statehtn.risk import (
    AdditiveObjective,
    Attitude,
    AttitudeName,
    Objective,
    ObjectiveLike,
    SuccessUtility,
    Utility,
    ValueUnit,
    adds_up,
    agent_name,
    agent_order,
    agents_of,
    plan_risk_cost,
)
from statehtn.settings import AGENTS_AS_OBJECTIVES, objective_of

Cells = tuple["PricedStep | None", ...]


@dataclass(frozen=True, slots=True)
class Difference:
    """A place where one plan has other actions than another, and what both cost an agent there.

    Args:
        own: the actions of the one plan; may be empty.
        other: those of the other plan in their place; may be empty.
        own_cost: the certainty equivalent of `own`, in the domain's unit; None where the agent has no price for a part
            of a plan.
        other_cost: the same agent's certainty equivalent of `other`.
    """

    own: tuple[PricedStep, ...]
    other: tuple[PricedStep, ...]
    own_cost: float | None
    other_cost: float | None

    def to_dict(self) -> dict[str, Any]:
        """Return the difference as plain data; actions as they stand in a plan."""
        return {
            "own": _names(self.own),
            "other": _names(self.other),
            "own_risk_cost": self.own_cost,
            "other_risk_cost": self.other_cost,
        }


@dataclass(frozen=True, slots=True, repr=False)
class AttitudeComparison:
    """The plans of several agents for one problem; prints them side by side, with what each is worth to the others.

    An agent is somebody with an objective.

    Args:
        results: one for each agent: in the order that was asked for, of attitudes from the most averse to the most
            seeking.
    """

    results: tuple[Result, ...]

    def __repr__(self) -> str:
        return f"<comparison of {', '.join(self.agents)}>"

    @property
    def agents(self) -> tuple[str, ...]:
        """The names of the agents, such as `averse 0.9` or `cvar 0.95`; those of the same name are numbered."""
        names = [agent_name(result.objective) for result in self.results]
        return tuple(
            name if names.count(name) == 1 else f"{name} ({names[: index + 1].count(name)})"
            for index, name in enumerate(names)
        )

    @property
    def stopped(self) -> Status | None:
        """What ended the last agent's run before it was done: after an interruption agents are missing."""
        return self.results[-1].stopped

    @property
    def values(self) -> tuple[tuple[float | None, ...], ...]:
        """What the plan of each agent (first index) is worth to each agent (second), in the unit of the second.

        None where there is no plan. No value of a column is below the one on the diagonal, if that plan is optimal.
        """
        wanted = [result.objective for result in self.results]
        return tuple(
            tuple(None if result.plan is None else value_of(result.plan, other) for other in wanted)
            for result in self.results
        )

    @property
    def risk_costs(self) -> tuple[tuple[float | None, ...], ...]:
        """The values that are costs: certainty equivalents of the plan of each agent (first) to each (second)."""
        units = [result.objective.unit for result in self.results]
        return tuple(
            tuple(value if unit is ValueUnit.COST else None for value, unit in zip(row, units, strict=True))
            for row in self.values
        )

    @property
    def rows(self) -> tuple[Cells, ...]:
        """The plans side by side: in each row a step of each plan, or None; what plans share stands in one row.

        Steps are the same if their action and the law of their cost are.
        """
        rows: list[list[PricedStep | None]] = []
        for width, result in enumerate(self.results):
            rows = _merged(rows, result.steps, width)
        return tuple(tuple(row) for row in rows)

    def differences(self, agent: int, other: int) -> tuple[Difference, ...]:
        """Return where the plan of an agent parts from another's, priced by the first; indices into `results`.

        Where the first has prices for parts of a plan, the differences between the costs add up to the difference
        between the values of the two plans.

        Raises:
            UsageError: there is no such agent.
        """
        for index in (agent, other):
            if not 0 <= whole_number(index, "the number of an agent") < len(self.results):
                raise UsageError(f"the number of an agent must be from 0 to {len(self.results) - 1}, found {index}")
        mine, its = self.results[agent], self.results[other]
        if not (mine and its):
            return ()
        return differences_between(mine.steps, its.steps, mine.objective)

    def to_dict(self) -> dict[str, Any]:
        """Return the object that `statehtn compare-attitudes --json` prints."""
        pairs = [(agent, other) for agent in range(len(self.results)) for other in range(len(self.results))]
        values, prices = self.values, self.risk_costs
        return {
            "agents": [
                {"attitude": result.attitude, "alpha": result.alpha, "objective": str(result.objective)}
                for result in self.results
            ],
            "results": [result.to_dict() for result in self.results],
            "values": [list(row) for row in values],
            "risk_costs": [list(row) for row in prices],
            "differences": [
                {
                    "agent": agent,
                    "other": other,
                    "value": values[agent][agent],
                    "other_value": values[other][agent],
                    "risk_cost": prices[agent][agent],
                    "other_risk_cost": prices[other][agent],
                    "parts": [part.to_dict() for part in parts],
                }
                for agent, other in pairs
                if (parts := self.differences(agent, other))
            ],
        }

    def __str__(self) -> str:
        from statehtn.display.comparison import comparison_text

        return comparison_text(self)

    def _repr_html_(self) -> str:
        from statehtn.display.comparison import comparison_html

        return comparison_html(self)


def differences_between(
    steps: Sequence[PricedStep], others: Sequence[PricedStep], objective: Objective
) -> tuple[Difference, ...]:
    """Return where the steps of one plan part from those of another, priced by an objective."""
    matcher = SequenceMatcher(None, tokens(steps), tokens(others), autojunk=False)
    price = _price_of(objective, (priced.law for priced in (*steps, *others)))
    found = []
    for tag, start, end, other_start, other_end in matcher.get_opcodes():
        if tag != "equal":
            own, other = tuple(steps[start:end]), tuple(others[other_start:other_end])
            found.append(Difference(own, other, price(own), price(other)))
    return tuple(found)


def _price_of(objective: Objective, laws: Iterable[CostLaw]) -> Callable[[Iterable[PricedStep]], float | None]:
    """Return what prices parts of plans with these laws by an objective: None for each where prices do not add up."""
    if not (isinstance(objective, AdditiveObjective) and adds_up(objective, laws)):
        return lambda _: None
    additive = objective
    counting_on = objective.outcome_price if isinstance(objective, SuccessUtility) else lambda _: 0.0

    def price(part: Iterable[PricedStep]) -> float:
        listed = list(part)
        counted_on = math.fsum(counting_on(priced.probability) for priced in listed)
        return plan_risk_cost((priced.law for priced in listed), additive) + counted_on

    return price


def compared_objectives(
    alpha: float | Iterable[float] | None,
    attitudes: Iterable[Attitude | AttitudeName] | None = None,
    objectives: Iterable[ObjectiveLike] | None = None,
) -> list[Objective]:
    """Return what is compared, each once: the objectives in their order, or agents of these attitudes, see there.

    Raises:
        UsageError: one of them is none, they are given in two ways, or there are none.
    """
    if objectives is None:
        agents = compared_agents(1.0 if alpha is None else alpha, tuple(Attitude) if attitudes is None else attitudes)
        return list(agents)
    if alpha is not None or attitudes is not None:
        raise UsageError(f"compare either objectives or attitudes with alphas: leave one out; {AGENTS_AS_OBJECTIVES}")
    listed = [objectives] if isinstance(objectives, str) else items(objectives, "'objectives'")
    if not listed:
        raise UsageError("there are no objectives to compare; give some, such as 'neutral' and 'cvar 0.95'")
    return list(dict.fromkeys(objective_of(wanted) for wanted in listed))


def compared_agents(alpha: float | Iterable[float], attitudes: Iterable[Attitude | AttitudeName]) -> list[Utility]:
    """Return the agents of these attitudes, each once: from the most averse to the most seeking.

    Raises:
        UsageError: an attitude or an alpha is none, or there are no agents.
    """
    alphas = items(alpha, "alpha") if isinstance(alpha, Iterable) and not isinstance(alpha, str) else [alpha]
    names = [attitudes] if isinstance(attitudes, str) else items(attitudes, "'attitudes'")
    agents = agents_of(
        [Attitude(one_of(name, list(Attitude), "attitude")) for name in names],
        [number(value, "alpha") for value in alphas],
    )
    if not agents:
        raise UsageError("there are no agents to compare; give an attitude, and alpha for averse and seeking ones")
    return sorted(set(agents), key=agent_order)


def _names(steps: Iterable[PricedStep]) -> list[str]:
    return [str(priced.step) for priced in steps]


def tokens(steps: Iterable[PricedStep | None]) -> list[object]:
    """Return what makes steps of several agents the same: the action, the law of its cost, what it counts on."""
    return [None if priced is None else (priced.step, priced.law, priced.probability) for priced in steps]


def _merged(
    rows: list[list[PricedStep | None]], steps: Sequence[PricedStep], width: int
) -> list[list[PricedStep | None]]:
    """Add a column with the steps of one more plan to rows of so many columns."""
    latest = [next(priced for priced in reversed(row) if priced is not None) for row in rows]
    found: list[list[PricedStep | None]] = []
    matcher = SequenceMatcher(None, tokens(latest), tokens(steps), autojunk=False)
    for _, start, end, new_start, new_end in matcher.get_opcodes():
        for offset in range(max(end - start, new_end - new_start)):
            row = rows[start + offset] if start + offset < end else [None] * width
            found.append([*row, steps[new_start + offset] if new_start + offset < new_end else None])
    return found
