"""The laws of what is paid on the branches of a policy."""

from __future__ import annotations

import math

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.law_grid import LawGrid
from statehtn.model import CostDistribution, CostLaw
from statehtn.model.cost.scenario_cost import sum_of

Execution = tuple[int | None, tuple[int, ...]]
"""A ground action, and the parts of its cost that were due; None where nothing is executed."""


class BranchLaws:
    """What branches cost where nothing spent is remembered: the law of what is executed.

    Args:
        grounding: the ground problem and its laws.
    """

    def __init__(self, grounding: Grounding) -> None:
        self.grounding = grounding
        self._laws: dict[Execution, CostLaw] = {(None, ()): CostDistribution.certain(0.0)}

    def of_run(self, run: _relax.PolicyRun) -> list[CostLaw]:
        """Return the law of each branch of the policy that was found."""
        return [self.of((action, tuple(run.due_parts(branch)))) for branch, action in enumerate(run.actions)]

    def of(self, execution: Execution) -> CostLaw:
        """Return the law of an execution."""
        law = self._laws.get(execution)
        if law is None:
            action, due = execution
            assert action is not None
            base = self.grounding.laws[action]
            law = sum_of([base, *(self.grounding.part_laws[part] for part in due)]) if due else base
            self._laws[execution] = law
        return law

    def left(self, run: _relax.PolicyRun, node: int) -> float | None:  # noqa: ARG002
        """Return what is left of an amount at a node; None, since decisions do not depend on one."""
        return None


class SpendingLaws(BranchLaws):
    """What branches cost where the amount spent is remembered: the law of what is executed, given what is left then.

    Args:
        grid: exact costs in steps.
    """

    def __init__(self, grid: LawGrid) -> None:
        super().__init__(grid.grounding)
        self.grid = grid.grid
        self._given: dict[tuple[Execution, int, int | None], CostLaw] = {}

    def of_run(self, run: _relax.PolicyRun) -> list[CostLaw]:
        """Return the law of each branch of the policy that was found."""
        first, successors, actions = run.first, run.successors, run.actions
        found = []
        for node in range(len(first) - 1):
            left = run.left(node)
            for branch in range(first[node], first[node + 1]):
                execution = (actions[branch], tuple(run.due_parts(branch)))
                law = self.of(execution)
                found.append(law if left is None else self._law_given(execution, left, run.left(successors[branch])))
        return found

    def left(self, run: _relax.PolicyRun, node: int) -> float | None:
        """Return what is left of the amount at a node, in the domain's unit; minus infinity where it is used up."""
        left = run.left(node)
        return -math.inf if left is None else float(self.grid.step * left)

    def _law_given(self, execution: Execution, left: int, rest: int | None) -> CostLaw:
        """Return the law given what is left afterwards."""
        key = (execution, left if rest is None else left - rest, None if rest is None else 0)
        law = self._given.get(key)
        if law is None:
            at, probabilities = self.grid.outcomes(self.of(execution))
            kept = [
                (probability, float(self.grid.step * int(steps)))
                for steps, probability in zip(at, probabilities, strict=True)
                if (steps > left if rest is None else steps == left - rest)
            ]
            total = math.fsum(probability for probability, _ in kept)
            law = CostDistribution.of((probability / total, cost) for probability, cost in kept)
            self._given[key] = law
        return law
