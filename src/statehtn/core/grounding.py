"""The ground problem: instances in the compiled core, and the cost law of every ground action."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import chain

import statehtn._relax as _relax
from statehtn.core.cost_laws import CostLaws
from statehtn.core.encode import Encoding, encode
from statehtn.core.outcomes import Outcomes
from statehtn.errors import InputError, UnsupportedError
from statehtn.limits import Limits, ending_by, watched
from statehtn.model import (
    CostLaw,
    GroundAction,
    GroundCostPart,
    GroundEffect,
    GroundMethod,
    GroundProblem,
    Problem,
)
from statehtn.model.cost.scenario_cost import ScenarioCost
from statehtn.model.status import Status

STOPPED = {
    _relax.StopReason.TimeLimit: Status.TIME_LIMIT,
    _relax.StopReason.MemoryLimit: Status.MEMORY_LIMIT,
    _relax.StopReason.Interrupted: Status.INTERRUPTED,
}
"""The status of a run that the core ended for a reason."""


@dataclass(frozen=True)
class GroundingSwitches:
    """Refinements of grounding: each makes ground problems smaller and keeps the set of plans.

    Args:
        split_methods: part choices of a method that have nothing to do with each other.
        merge_equal: let equal precondition actions be one, and equal methods of a task.
        replace_single_methods: replace tasks of a single method by its subtasks, where that does not copy much.
        mutexes: leave out actions whose preconditions never hold together, as far as pairs of facts tell (h^2).
    """

    split_methods: bool = True
    merge_equal: bool = True
    replace_single_methods: bool = True
    mutexes: bool = True


PLAIN = GroundingSwitches(split_methods=False, merge_equal=False, replace_single_methods=False, mutexes=False)
"""Tasks and methods as they stand in the domain, one by one."""


@dataclass(frozen=True)
class Grounding:
    """A ground problem and what it was made from.

    Args:
        problem: the lifted problem.
        encoding: what the core's numbers mean.
        handle: the ground problem in the core.
        laws: what is always due of the cost of each ground action; equal ones are mostly the same object.
        part_laws: what else is due under a condition, by cost part. All parts of a cost are independent.
        switches: which refinements were on.
        probabilities: by ground action, how likely it is that nature chooses it where it is one of several outcomes;
            otherwise 1.
    """

    problem: Problem
    encoding: Encoding
    handle: _relax.GroundProblem
    laws: tuple[CostLaw, ...]
    part_laws: tuple[CostLaw, ...]
    switches: GroundingSwitches
    probabilities: tuple[Fraction, ...]

    @property
    def fact_count(self) -> int:
        """The number of facts that can change and that something reads."""
        return self.handle.fact_count

    @cached_property
    def has_scenarios(self) -> bool:
        """Whether a cost depends on hidden facts, so that costs of actions hang together."""
        return any(isinstance(law, ScenarioCost) for law in chain(self.laws, self.part_laws))

    @property
    def action_count(self) -> int:
        """The number of ground actions of the domain, each counted once for every case and every outcome."""
        return sum(self.encoding.actions[schema] is not None for schema in self.handle.action_schema)

    @property
    def task_count(self) -> int:
        """The number of ground compound tasks, those that only the grounder knows included."""
        return self.handle.compound_count

    @property
    def method_count(self) -> int:
        """The number of ground methods, those that only the grounder knows included."""
        return self.handle.method_count

    def objects(self, numbers: list[int]) -> tuple[str, ...]:
        """Return the names of objects."""
        return tuple(self.encoding.objects[number] for number in numbers)

    def seen_facts(self) -> frozenset[tuple[str, ...]]:
        """Return the facts that can change and that something reads: by these the search tells states apart."""
        handle = self.handle
        return frozenset(
            (self.encoding.predicates[predicate], *self.objects(handle.fact_arguments(fact)))
            for fact, predicate in enumerate(handle.fact_predicate)
        )

    def to_model(self) -> GroundProblem:
        """Return the ground problem as Python objects, numbered as in the core; for reading, not for large problems."""
        return self._model

    @cached_property
    def _model(self) -> GroundProblem:
        handle = self.handle
        task_count = handle.action_count + handle.compound_count
        return GroundProblem(
            facts=tuple(
                (self.encoding.predicates[predicate], *self.objects(handle.fact_arguments(fact)))
                for fact, predicate in enumerate(handle.fact_predicate)
            ),
            actions=tuple(self._action(action, schema) for action, schema in enumerate(handle.action_schema)),
            tasks=tuple(
                (self.task_name(schema), *self.objects(handle.compound_arguments(task)))
                for task, schema in enumerate(handle.compound_schema)
            ),
            methods=tuple(self._method(method) for method in range(handle.method_count)),
            initial_state=frozenset(handle.initial_state),
            initial_task=handle.initial_task,
            is_plain=self.switches == PLAIN,
            chance_tasks=frozenset(filter(handle.is_chance, range(handle.action_count, task_count))),
        )

    def task_name(self, schema: int) -> str:
        """Return the name of a lifted task: an action's or a compound task's."""
        names = self.encoding.action_names
        return names[schema] if schema < len(names) else self.encoding.tasks[schema - len(names)]

    def action_text(self, action: int) -> str:
        """Return a ground action as it stands in a plan."""
        names = (self.task_name(self.handle.action_schema[action]), *self.objects(self.handle.action_arguments(action)))
        return f"({' '.join(names)})"

    def cost_part_text(self, part: int) -> str:
        """Return the ground action that a cost part belongs to, as it stands in a plan."""
        actions = range(self.handle.action_count)
        return self.action_text(bisect_right(actions, part, key=lambda action: self.handle.cost_parts(action)[0]) - 1)

    def _action(self, action: int, schema: int) -> GroundAction:
        handle = self.handle
        return GroundAction(
            self.encoding.action_names[schema],
            self.objects(handle.action_arguments(action)),
            frozenset(handle.preconditions(action)),
            frozenset(handle.negative_preconditions(action)),
            tuple(
                GroundEffect(
                    frozenset(handle.effect_adds(effect)),
                    frozenset(handle.effect_deletes(effect)),
                    frozenset(handle.effect_conditions(effect)),
                    frozenset(handle.effect_negative_conditions(effect)),
                )
                for effect in range(*handle.effects(action))
            ),
            self.laws[action],
            self.encoding.actions[schema] is None,
            tuple(map(self._cost_part, range(*handle.cost_parts(action)))),
            self.probabilities[action],
        )

    def _cost_part(self, part: int) -> GroundCostPart:
        alternatives = (
            (
                frozenset(self.handle.cost_conditions(alternative)),
                frozenset(self.handle.cost_negative_conditions(alternative)),
            )
            for alternative in range(*self.handle.cost_alternatives(part))
        )
        return GroundCostPart(tuple(alternatives), self.part_laws[part])

    def _method(self, method: int) -> GroundMethod:
        handle = self.handle
        parts = range(*handle.method_parts(method))
        lifted = self.encoding.schemes[handle.part_schema(parts.start)].method if parts else None
        is_chance = not parts and handle.is_chance(handle.method_task(method))
        name = lifted.name if lifted else "initial network" if parts else "outcome" if is_chance else "case"
        return GroundMethod(
            name,
            self.objects(handle.part_arguments(parts.start)) if parts else (),
            handle.method_task(method),
            tuple(handle.method_subtasks(method)),
            tuple(handle.method_ordering(method)),
        )


def ground(problem: Problem, limits: Limits = Limits(), switches: GroundingSwitches = GroundingSwitches()) -> Grounding:
    """Ground a problem: only what can be reached, and only what the initial network can lead to.

    Args:
        problem: the lifted problem.
        limits: they hold for grounding, too.
        switches: `PLAIN` for graphs and the reference solver, which speak of the domain's own methods. Where actions
            have several outcomes, methods are not split: an agent must not choose a part of a method after it has seen
            an outcome.

    Raises:
        LimitReached, KeyboardInterrupt: a limit was reached, or Ctrl-C pressed.
        InputError: the cost of a reachable action is no distribution. What is not defined is taken as 0, with a
            `CostWarning` (see `statehtn.model.cost.unknown`).
            A probability of outcomes is none, or an action has more than 64 outcomes with different facts.
        UnsupportedError: a precondition falls into too many cases.
    """
    if problem.domain.has_outcomes:
        switches = replace(switches, split_methods=False)
    with watched(limits):
        encoding = encode(problem, switches.split_methods)
    handle = _relax.ground(
        encoding.handle,
        switches.merge_equal,
        switches.replace_single_methods,
        switches.mutexes,
        *limits.left(),
    )
    if isinstance(handle, _relax.StopReason):
        raise ending_by(STOPPED[handle])
    if isinstance(handle, tuple):
        action, arguments, has_many_outcomes = handle
        name = " ".join((encoding.action_names[action], *(encoding.objects[number] for number in arguments)))
        if has_many_outcomes:
            lifted = encoding.actions[action]
            raise InputError(
                f"({name}) has more than 64 outcomes with different facts; can its effects be stated with fewer?",
                lifted.outcomes[0].place if lifted else None,
            )
        raise UnsupportedError(
            f"the precondition or the cost of ({name}) falls into too many cases; can it be stated more simply?"
        )
    with watched(limits):
        outcomes = Outcomes(encoding, handle, limits)
        probabilities = outcomes.probabilities()
        laws, part_laws = CostLaws(encoding, handle, outcomes, limits).all()
    return Grounding(problem, encoding, handle, laws, part_laws, switches, probabilities)
