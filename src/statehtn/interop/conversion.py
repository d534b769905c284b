"""A problem in two forms, here and in unified-planning (UP), and the plans of both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from unified_planning.model.htn import HierarchicalProblem
from unified_planning.plans import HierarchicalPlan

from statehtn.counted import with_article
from statehtn.errors import UsageError
from statehtn.interop.costs import CostParts, with_distributions
from statehtn.interop.names import Vocabulary
from statehtn.interop.plans import read_up_plan, write_up_plan
from statehtn.interop.read_problem import read_up_problem
from statehtn.interop.write_problem import write_up_problem
from statehtn.model import Plan, Problem


@dataclass(frozen=True)
class Conversion:
    """A problem in both forms; make one by `from_up` or `to_up`.

    Args:
        problem: the problem here.
        up_problem: the problem in UP.
        names: what is called what.
    """

    problem: Problem
    up_problem: HierarchicalProblem
    names: Vocabulary

    @staticmethod
    def from_up(
        up_problem: HierarchicalProblem, cost_distributions: Mapping[Any, CostParts] | None = None
    ) -> Conversion:
        """Convert a problem of UP; arguments and errors are those of `statehtn.from_unified_planning`."""
        if not isinstance(up_problem, HierarchicalProblem):
            found = with_article(type(up_problem).__name__)
            raise UsageError(f"expected a HierarchicalProblem of unified-planning, found {found}")
        problem, names = read_up_problem(up_problem)
        if cost_distributions:
            problem = with_distributions(problem, cost_distributions, names.tasks)
        return Conversion(problem, up_problem, names)

    @staticmethod
    def to_up(problem: Problem) -> Conversion:
        """Convert a problem to UP; errors are those of `statehtn.to_unified_planning`."""
        return Conversion(problem, *write_up_problem(problem))

    def plan_to_up(self, plan: Plan) -> HierarchicalPlan:
        """Return a plan as one of UP.

        Raises:
            UsageError: the plan does not tell the arguments of its methods, as one that was read from a file.
        """
        return write_up_plan(plan, self.up_problem, self.names)

    def plan_from_up(self, plan: HierarchicalPlan) -> Plan:
        """Return a plan of UP as one of ours.

        Raises:
            UsageError: it is no hierarchical plan over a sequence of actions.
            InputError: it is of another problem, or its decomposition misses something.
        """
        return read_up_plan(plan, self.up_problem, self.names)
