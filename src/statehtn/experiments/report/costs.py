"""What risk attitude means: for each problem, the distribution of the total cost of every agent's plan."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from statehtn.experiments.report.cases import Case, Question, agent_order, best_of, by_question
from statehtn.experiments.report.plots import DASHES, Curve, Look, distributions
from statehtn.experiments.report.results import Agent, Outcome
from statehtn.experiments.report.tables import Cell, Column, Table, number
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.sum import TotalCost, total_cost

SHADES = 3
"""So many colours there are for averse, and for seeking agents."""


@dataclass(frozen=True, slots=True)
class Picture:
    """The distributions of one problem.

    Args:
        name: of the figure, unique on the page.
        domain: of the problem.
        problem: its name.
        svg: the figure.
        table: a row for each agent.
        looks: how the curve of each row of the table is drawn.
        is_exact: no distribution was put on a grid.
    """

    name: str
    domain: str
    problem: str
    svg: str
    table: Table
    looks: Sequence[Look]
    is_exact: bool


def cost_pictures(cases: Sequence[Case]) -> tuple[list[Picture], int]:
    """Return a picture for each problem that has plans, and how many problems were left out.

    A problem is left out if all its plans cost the same for certain: there is nothing to see.
    """
    plans: dict[tuple[str, str], list[Outcome]] = {}
    question: Question
    for question, group in by_question(cases).items():
        best = best_of(group)
        if best is not None and best.laws is not None:
            plans.setdefault(question[:2], []).append(best)
    looks = _looks(sorted({outcome.agent for group in plans.values() for outcome in group}, key=agent_order))
    pictures: list[Picture] = []
    certain = 0
    for (domain, problem), outcomes in plans.items():
        totals = [total_cost(outcome.laws or ()) for outcome in outcomes]
        if max(total.most for total in totals) <= min(total.least for total in totals):
            certain += 1
        else:
            pictures.append(_picture(f"costs-{len(pictures) + 1}", domain, problem, outcomes, totals, looks))
    return pictures, certain


def _looks(agents: Sequence[Agent]) -> dict[Agent, Look]:
    """Give each agent a colour by its attitude, the more extreme the stronger; and a dash pattern."""
    looks = {}
    for attitude, sign in (("averse", 1), ("seeking", -1)):
        own = [agent for agent in agents if agent.split()[0] == attitude][::sign]  # from the most extreme on
        for rank, agent in enumerate(own):
            dash = list(DASHES)[min(rank, len(DASHES) - 1)]
            looks[agent] = Look(f"{attitude}-{min(rank, SHADES - 1) + 1}", dash=dash)
    others = [agent for agent in agents if agent not in looks and agent != "neutral"]
    looks |= {agent: Look(f"series-{index % 6 + 1}", dash="mixed") for index, agent in enumerate(others)}
    return {agent: looks.get(agent, Look("neutral")) for agent in agents}


def _picture(
    name: str,
    domain: str,
    problem: str,
    outcomes: Sequence[Outcome],
    totals: Sequence[CostDistribution],
    looks: dict[Agent, Look],
) -> Picture:
    groups: list[list[int]] = []  # the outcomes whose plans cost the same
    for index, total in enumerate(totals):
        same = next((group for group in groups if _is_same(totals[group[0]], total)), None)
        if same is None:
            groups.append([index])
        else:
            same.append(index)
    drawn: dict[int, Look] = {}
    for group in groups:  # drawn as the least extreme of them is
        mildest = min((outcomes[index].agent for index in group), key=lambda agent: abs(agent_order(agent)[0]))
        drawn |= dict.fromkeys(group, looks[mildest])
    columns = [
        Column("agent", is_text=True),
        *(Column(label) for label in ("expected", "value", "least", "5 %", "median", "95 %", "most")),
    ]
    rows = [_row(outcome, total) for outcome, total in zip(outcomes, totals, strict=True)]
    label = f"Distributions of the total cost in {problem}: " + "; ".join(
        f"{outcome.agent} from {total.least:g} to {total.most:g}, expected {total.mean:g}"
        for outcome, total in zip(outcomes, totals, strict=True)
    )
    return Picture(
        name,
        domain,
        problem,
        distributions(name, label, [Curve(totals[group[0]], drawn[group[0]]) for group in groups]),
        Table(f"{problem}: total cost of the plan for each agent", columns, rows),
        [drawn[index] for index in range(len(outcomes))],
        not any(isinstance(total, TotalCost) for total in totals),
    )


def _is_same(left: CostDistribution, right: CostDistribution) -> bool:
    import numpy as np

    return len(left.outcomes) == len(right.outcomes) and np.allclose(left.outcomes, right.outcomes)


def _row(outcome: Outcome, total: CostDistribution) -> list[Cell]:
    values = (
        *(outcome.expected_cost, outcome.value),
        *(total.least, total.quantile(0.05), total.quantile(0.5), total.quantile(0.95), total.most),
    )
    return [Cell(outcome.agent, agent_order(outcome.agent)[0]), *(number(value, 4) for value in values)]
