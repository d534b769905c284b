"""The ground problem: instances in the compiled core, and the cost law of every ground action."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property

import statehtn._relax as _relax
from statehtn.core.encode import Encoding, encode
from statehtn.errors import UnsupportedError
from statehtn.limits import LimitReached, Limits
from statehtn.model import CostDistribution, CostLaw, GroundAction, GroundEffect, GroundMethod, GroundProblem, Problem
from statehtn.model.cost_law import action_law, is_unconditional
from statehtn.model.costs import Arithmetic, Expression, FunctionTerm
from statehtn.model.problem import Action
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
        merge_equal: let equal artificial actions be one, and equal methods of a task.
        replace_single_methods: replace tasks of a single method by its subtasks, where that does not copy much.
    """

    split_methods: bool = True
    merge_equal: bool = True
    replace_single_methods: bool = True


PLAIN = GroundingSwitches(split_methods=False, merge_equal=False, replace_single_methods=False)
"""Tasks and methods as they stand in the domain, one by one."""


@dataclass(frozen=True)
class Grounding:
    """A ground problem and what it was made from.

    Args:
        problem: the lifted problem.
        encoding: what the core's numbers mean.
        handle: the ground problem in the core.
        laws: the cost distribution of each ground action; equal ones are mostly the same object.
        switches: which refinements were on.
    """

    problem: Problem
    encoding: Encoding
    handle: _relax.GroundProblem
    laws: tuple[CostLaw, ...]
    switches: GroundingSwitches

    @property
    def fact_count(self) -> int:
        """The number of facts that can change and that something reads."""
        return self.handle.fact_count

    @property
    def action_count(self) -> int:
        """The number of ground actions of the domain, each counted once for every case of its precondition or cost."""
        return sum(self.encoding.actions[schema] is not None for schema in self.handle.action_schema)

    @property
    def task_count(self) -> int:
        """The number of ground compound tasks, the artificial ones included."""
        return self.handle.compound_count

    @property
    def method_count(self) -> int:
        """The number of ground methods, the artificial ones included."""
        return self.handle.method_count

    def objects(self, numbers: list[int]) -> tuple[str, ...]:
        """Return the names of objects."""
        return tuple(self.encoding.objects[number] for number in numbers)

    def to_model(self) -> GroundProblem:
        """Return the ground problem as Python objects, numbered as in the core; for reading, not for large problems."""
        return self._model

    @cached_property
    def _model(self) -> GroundProblem:
        handle = self.handle
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
        )

    def task_name(self, schema: int) -> str:
        """Return the name of a lifted task: an action's or a compound task's."""
        names = self.encoding.action_names
        return names[schema] if schema < len(names) else self.encoding.tasks[schema - len(names)]

    def action_text(self, action: int) -> str:
        """Return a ground action as it stands in a plan."""
        names = (self.task_name(self.handle.action_schema[action]), *self.objects(self.handle.action_arguments(action)))
        return f"({' '.join(names)})"

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
        )

    def _method(self, method: int) -> GroundMethod:
        handle = self.handle
        parts = range(*handle.method_parts(method))
        lifted = self.encoding.schemes[handle.part_schema(parts.start)].method if parts else None
        name = lifted.name if lifted else "initial network" if parts else "case"
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
        switches: `PLAIN` for graphs and the reference solver, which speak of the domain's own methods.

    Raises:
        LimitReached: a limit was reached, or Ctrl-C.
        InputError: the cost of a reachable action is not defined, or is no distribution.
        UnsupportedError: a precondition falls into too many cases.
    """
    encoding = encode(problem, switches.split_methods)
    handle = _relax.ground(
        encoding.handle,
        switches.merge_equal,
        switches.replace_single_methods,
        None if limits.deadline is None else limits.deadline - time.monotonic(),
        None if limits.memory_mb is None else int(limits.memory_mb * 1e6),
    )
    if isinstance(handle, _relax.StopReason):
        raise LimitReached(STOPPED[handle])
    if isinstance(handle, tuple):
        action, arguments = handle
        name = " ".join((encoding.action_names[action], *(encoding.objects[number] for number in arguments)))
        raise UnsupportedError(
            f"the precondition or the cost of ({name}) falls into too many cases; can it be stated more simply?"
        )
    return Grounding(problem, encoding, handle, tuple(_laws(encoding, handle, limits)), switches)


def _laws(encoding: Encoding, handle: _relax.GroundProblem, limits: Limits) -> list[CostLaw]:
    """Return the cost law of every ground action, the same object wherever it cannot depend on the arguments."""
    free = CostDistribution.certain(0.0)
    unit_costs = encoding.problem.domain.has_unit_costs
    values = encoding.problem.function_values
    shared: dict[int, CostLaw] = {}
    laws: list[CostLaw] = []
    for number, schema in enumerate(handle.action_schema):
        if number % 1024 == 0:
            limits.check()
        action = encoding.actions[schema]
        if action is None:
            laws.append(free)
        elif schema in shared:
            laws.append(shared[schema])
        else:
            if any(block.external for block in action.costs):
                limits.check()  # a callable may take its time
            arguments = tuple(encoding.objects[object_] for object_ in handle.action_arguments(number))
            parts = _active_parts(encoding, handle.action_cost_parts(number))
            laws.append(action_law(action, arguments, parts, values, unit_costs))
            if unit_costs or _is_the_same_for_all(action):
                shared[schema] = laws[-1]
    return laws


def _active_parts(encoding: Encoding, record: list[int]) -> list[tuple[int, tuple[str, ...]]]:
    """Read which conditional parts of a cost are due: (block, objects of its variables)."""
    parts = []
    at = 0
    while at < len(record):
        block, count = record[at : at + 2]
        parts.append((block, tuple(encoding.objects[number] for number in record[at + 2 : at + 2 + count])))
        at += 2 + count
    return parts


def _is_the_same_for_all(action: Action) -> bool:
    """Tell whether an action costs the same for all arguments in all states."""

    def is_constant(expression: Expression) -> bool:
        match expression:
            case FunctionTerm(_, arguments):
                return not arguments
            case Arithmetic(_, operands):
                return all(map(is_constant, operands))
        return True

    return all(
        is_unconditional(block)
        and block.external is None
        and all(is_constant(expression) for branch in block.branches for expression in branch)
        for block in action.costs
    )
