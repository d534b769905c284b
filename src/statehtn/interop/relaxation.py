"""The relaxed composition model as a classical problem of unified-planning (UP).

It is the model of `statehtn.reference.relaxed_model`, with what actions make false. Sources: the paper's section on
state-based solving (`buildRCModel` of Algorithm 5); Höller et al., "A generic method to guide HTN progression search
with classical heuristics" (ICAPS 2018).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from unified_planning.environment import get_environment
from unified_planning.io import PDDLWriter
from unified_planning.model import Fluent, InstantaneousAction
from unified_planning.model import Problem as UpProblem
from unified_planning.model.metrics import MinimizeActionCosts

from statehtn.core.grounding import PLAIN, ground
from statehtn.model import GroundAction, GroundCostPart, GroundMethod, GroundProblem, Problem
from statehtn.model.cost.blocks import exact
from statehtn.risk import Utility
from statehtn.risk.cost_shifting import shifted_prices

DIGITS = 10
"""Costs are rounded to so many significant digits, which is what UP's writer of PDDL holds."""


def relaxed_problem(problem: Problem, objective: Utility) -> UpProblem:
    """Return the relaxed model of the initial node; described at `statehtn.relax`."""
    return _Builder(ground(problem, switches=PLAIN).to_model(), objective, f"{problem.name}-relaxed").build()


def pddl(problem: UpProblem) -> tuple[str, str]:
    """Return a classical problem of UP as PDDL: the domain and the problem."""
    writer = PDDLWriter(problem)
    return writer.get_domain(), writer.get_problem()


class _Builder:
    """Declares facts and operators, each under a name of its own."""

    def __init__(self, ground_problem: GroundProblem, utility: Utility, name: str) -> None:
        self.ground = ground_problem
        self.utility = utility
        self.environment = get_environment()
        self.up = UpProblem(name, self.environment)
        self.names: set[str] = set()
        self.costs: dict[Any, Any] = {}
        state = ground_problem.initial_state
        self.facts = [self.fact(shown(fact), number in state) for number, fact in enumerate(ground_problem.facts)]
        self.lacking = {
            number: self.fact(f"not {shown(ground_problem.facts[number])}", number not in state)
            for number in sorted(read_false(ground_problem))
        }
        tasks = [(action.name, *action.arguments) for action in ground_problem.actions]
        # Between the beginning of an action whose cost has parts and its end nothing else changes the state.
        self.idle: Any = None
        if any(action.cost_parts for action in ground_problem.actions):
            self.idle = self.fact("idle", True)
        self.reached = [self.fact(f"reached {shown(task)}", False) for task in (*tasks, *ground_problem.tasks)]

    def build(self) -> UpProblem:
        """Return the problem with all operators."""
        for task, action in enumerate(self.ground.actions):
            self.add_action(task, action)
        for method in self.ground.methods:
            self.add_method(method)
        # A problem that grounding has found to be unsolvable has no tasks left.
        is_left = self.ground.initial_task < len(self.reached)
        self.up.add_goal(self.reached[self.ground.initial_task] if is_left else self.fact("reached nothing", False))
        self.up.add_quality_metric(MinimizeActionCosts(self.costs))
        return self.up

    def unique(self, name: str) -> str:
        """Return the name, with a number where there are several of it."""
        candidate, number = name, 1
        while candidate in self.names:
            number += 1
            candidate = f"{name} #{number}"
        self.names.add(candidate)
        return candidate

    def fact(self, name: str, is_true: bool) -> Any:
        """Declare a fact with its value in the initial state."""
        fluent = Fluent(self.unique(name), environment=self.environment)
        self.up.add_fluent(fluent, default_initial_value=is_true)
        return fluent()

    def conditions(self, positive: Iterable[int], negative: Iterable[int]) -> list[Any]:
        """Return the facts that say that some hold and others do not."""
        return [*(self.facts[f] for f in sorted(positive)), *(self.lacking[f] for f in sorted(negative))]

    def operator(self, name: str, conditions: Iterable[Any], gained: Any, cost: float = 0.0) -> InstantaneousAction:
        """Add an operator that makes a fact true, with a cost in the domain's unit."""
        operator = InstantaneousAction(self.unique(name), _env=self.environment)
        for condition in conditions:
            operator.add_precondition(condition)
        operator.add_effect(gained, True)
        rounded = exact(float(f"{cost:.{DIGITS}g}"))
        (self.costs[operator],) = self.environment.expression_manager.auto_promote(rounded)
        self.up.add_action(operator)
        return operator

    def add_action(self, task: int, action: GroundAction) -> None:
        """Add the operator of an action: it does what the action does, and reaches it as a task."""
        name = shown((action.name, *action.arguments))
        needed = self.conditions(action.precondition, action.negative_precondition)
        if self.idle is not None:
            needed.append(self.idle)
        cost, prices = shifted_prices(action.cost, action.cost_parts, self.utility)
        if action.cost_parts:
            needed = [self.settle(name, needed, action.cost_parts, prices)]
        operator = self.operator(name, needed, self.reached[task], cost)
        if action.cost_parts:
            operator.add_effect(self.idle, True)
            operator.add_effect(needed[0], False)
        for effect in action.effects:
            condition = self.environment.expression_manager.And(
                self.conditions(effect.condition, effect.negative_condition)
            )
            for facts, value in ((effect.deleted, False), (effect.added, True)):
                for number in sorted(facts):
                    operator.add_effect(self.facts[number], value, condition)
                    if number in self.lacking:
                        operator.add_effect(self.lacking[number], not value, condition)

    def settle(self, name: str, needed: Iterable[Any], parts: Sequence[GroundCostPart], prices: Sequence[float]) -> Any:
        """Add operators that settle the parts of an action's cost in turn: a part is paid for if it is due.

        Returns the fact that all of them are settled, which the action needs.
        """
        settled = self.fact(f"begun {name}", False)
        self.operator(f"begin {name}", needed, settled).add_effect(self.idle, False)
        for number, (part, price) in enumerate(zip(parts, prices, strict=True)):
            before, settled = settled, self.fact(f"settled {number} {name}", False)
            failed = [self.fact(f"failed {number} {name}", False) for _ in part.alternatives]
            last = [self.operator(f"spare {number} {name}", [before, *failed], settled)]
            for (true, false), failure in zip(part.alternatives, failed, strict=True):
                last.append(
                    self.operator(f"pay {number} {name}", [before, *self.conditions(true, false)], settled, price)
                )
                for condition in self.conditions(false, true):
                    self.operator(f"fail {number} {name}", [before, condition], failure)
            for operator in last:
                for fact in (before, *failed):
                    operator.add_effect(fact, False)
        return settled

    def add_method(self, method: GroundMethod) -> None:
        """Add the operator of a method: its task is reached once its subtasks are."""
        needed = [self.reached[subtask] for subtask in sorted(set(method.subtasks))]
        self.operator(shown((method.name, *method.arguments)), needed, self.reached[method.task])


def shown(atom: tuple[str, ...]) -> str:
    """Return the name of an atom, a task or an operator."""
    return " ".join(atom)


def read_false(problem: GroundProblem) -> set[int]:
    """Return the facts that some action needs to be false, or that decide what it costs."""
    parts = [part for action in problem.actions for part in action.cost_parts]
    return set().union(
        *(true | false for part in parts for true, false in part.alternatives),
        *(action.negative_precondition for action in problem.actions),
        *(effect.negative_condition for action in problem.actions for effect in action.effects),
    )
