"""Unified-planning (UP): its problems as ours and ours as its, plans likewise, and the relaxed model for its planners.

UP is an optional package, and imported when a function here needs it. The engine is `statehtn.engine`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from statehtn.errors import UsageError
from statehtn.model import Problem
from statehtn.model.expect import expect_problem
from statehtn.risk import Attitude, AttitudeName, utility_for

if TYPE_CHECKING:
    from unified_planning.environment import Environment
    from unified_planning.model import Problem as UpProblem
    from unified_planning.model.htn import HierarchicalProblem

    from statehtn.build import CostPart
    from statehtn.interop.conversion import Conversion
    from statehtn.interop.costs import CostParts

__all__ = [
    "Conversion",
    "cost_distributions",
    "from_unified_planning",
    "register",
    "relax",
    "relax_to_pddl",
    "to_unified_planning",
]

ENGINE = ("statehtn", "statehtn.engine", "StateHtnEngine")
"""The engine's name in UP, its module and its class; so they stand in a file `up.ini`, too."""


def from_unified_planning(
    problem: HierarchicalProblem, cost_distributions: Mapping[Any, CostParts] | None = None
) -> Problem:
    """Return a hierarchical problem of unified-planning as one of ours.

    Conditions, constraints of task networks and costs are kept, or refused. Fluents with objects as values become
    predicates with the value as last argument. The metric is `MinimizeActionCosts`; without one, and with
    `MinimizeSequentialPlanLength`, every action costs 1. What HDDL forbids in a name becomes `_`, and
    names that differ in case only get a number.

    Args:
        problem: any that the engine supports; for plans take `statehtn.interop.Conversion`, which knows the names.
        cost_distributions: uncertain costs by action or name of an action, which replace the metric's: numbers,
            distributions, `chance(...)`, Python callables of the names of objects, or a list of them that adds up.
            They are positive, in the metric's unit.

    Raises:
        UnsupportedError: the problem has something else, such as times or numbers in conditions.
        UsageError: unified-planning is missing, or a cost is none.
    """
    return _conversion().from_up(problem, cost_distributions).problem


def to_unified_planning(problem: Problem) -> HierarchicalProblem:
    """Return a problem as a hierarchical problem of unified-planning, in its global environment.

    An action costs there what it is expected to cost; `cost_distributions` tells the rest. Constraints of methods
    become constraints of task networks. A name that two things share gets the kind of the second as its suffix.

    Raises:
        UnsupportedError: the problem has something that UP cannot hold: costs that depend on the state or are Python
            callables, types with several supertypes, variables of several types, methods for a task with an object.
        UsageError: unified-planning is missing.
    """
    return _conversion().to_up(expect_problem(problem)).up_problem


def cost_distributions(problem: Problem) -> dict[str, tuple[CostPart, ...]]:
    """Return the uncertain costs of a problem by UP's names of actions, for `from_unified_planning` and the engine.

    Raises:
        UnsupportedError: a cost depends on the state.
    """
    from statehtn.interop import costs

    return costs.cost_distributions(expect_problem(problem))


def relax(
    problem: Problem, *, attitude: Attitude | AttitudeName = Attitude.NEUTRAL, alpha: float | None = None
) -> UpProblem:
    """Return the relaxed composition model of a problem as a classical problem of unified-planning with action costs.

    Its facts are those of the state, `not ...` for those that must be false somewhere, and `reached ...` for tasks. An
    action does what it does, reaches its task, and costs its risk cost (10 significant digits, in the domain's unit);
    a method reaches its task, for nothing, once its subtasks have been reached. The goal is that the initial network
    has been. Every plan of the problem is one of the model, with a method after its subtasks; what the model forgets
    is their order and how often they occur. So any admissible estimate for the model is one for the problem. (Paper:
    `buildRCModel` of Algorithm 5.)

    Args:
        attitude: neutral, averse or seeking.
        alpha: how much an averse or a seeking agent cares about risk: positive, per unit of cost.

    Raises:
        UsageError: unified-planning is missing, or the agent is none.
    """
    _require()
    from statehtn.interop.relaxation import relaxed_problem

    return relaxed_problem(expect_problem(problem), utility_for(attitude, alpha))


def relax_to_pddl(
    problem: Problem, *, attitude: Attitude | AttitudeName = Attitude.NEUTRAL, alpha: float | None = None
) -> tuple[str, str]:
    """Return the relaxed model, as `relax` does, as PDDL text: domain and problem.

    The arguments `problem`, `attitude` and `alpha`, and what it raises: see `relax`.
    """
    model = relax(problem, attitude=attitude, alpha=alpha)
    from statehtn.interop.relaxation import pddl

    return pddl(model)


def register(environment: Environment | None = None) -> None:
    """Let unified-planning find the engine by its name `statehtn`, once and for this process.

    Args:
        environment: UP's; the global one where it is left out.

    Raises:
        UsageError: unified-planning is missing.
    """
    _require()
    from unified_planning.environment import get_environment

    factory = get_environment(environment).factory
    if ENGINE[0] not in factory.engines:
        factory.add_engine(*ENGINE)


def _conversion() -> type[Conversion]:
    _require()
    from statehtn.interop.conversion import Conversion

    return Conversion


def _require() -> None:
    """Import unified-planning.

    Raises:
        UsageError: it is missing.
    """
    try:
        import unified_planning  # noqa: F401
    except ImportError:
        raise UsageError("this needs the package 'unified-planning': pip install 'statehtn[up]'") from None


if not TYPE_CHECKING:  # a type checker would take every name, also a misspelt one

    def __getattr__(name: str) -> Any:
        if name == "Conversion":
            return _conversion()
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
