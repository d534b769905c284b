"""The ground problem: instances in the compiled core, and the cost law of every ground action."""

from __future__ import annotations

import warnings
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

import statehtn._relax as _relax
from statehtn.core.encode import CostPart, Encoding, encode
from statehtn.errors import UnsupportedError
from statehtn.limits import LimitReached, Limits, watched
from statehtn.model import (
    CostBlock,
    CostDistribution,
    CostLaw,
    CostSum,
    GroundAction,
    GroundCostPart,
    GroundEffect,
    GroundMethod,
    GroundProblem,
    Problem,
)
from statehtn.model.cost.blocks import Arithmetic, Expression, FunctionTerm
from statehtn.model.cost.ground_cost import (
    UNIT_COST,
    CostWarning,
    block_law,
    is_unconditional,
    sum_in_scenario,
    sum_of_blocks,
)
from statehtn.model.cost.scenario_cost import ScenarioCost, by_scenario
from statehtn.model.cost.unknown import MissingNumber, UnknownCost
from statehtn.model.problem import Action, Fact
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
    """

    problem: Problem
    encoding: Encoding
    handle: _relax.GroundProblem
    laws: tuple[CostLaw, ...]
    part_laws: tuple[CostLaw, ...]
    switches: GroundingSwitches

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
        """The number of ground actions of the domain, each counted once for every case of its precondition."""
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
        InputError: the cost of a reachable action is no distribution. What is not defined is taken as 0, with a
            `CostWarning` (see `statehtn.model.cost.unknown`).
        UnsupportedError: a precondition falls into too many cases.
    """
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
        raise LimitReached(STOPPED[handle])
    if isinstance(handle, tuple):
        action, arguments = handle
        name = " ".join((encoding.action_names[action], *(encoding.objects[number] for number in arguments)))
        raise UnsupportedError(
            f"the precondition or the cost of ({name}) falls into too many cases; can it be stated more simply?"
        )
    with watched(limits):
        laws, part_laws = _CostLaws(encoding, handle, limits).all()
    return Grounding(problem, encoding, handle, laws, part_laws, switches)


Blocks = list[tuple[int, tuple[str, ...]]]
"""Blocks of a cost: (index in `Action.costs`, objects of its variables)."""
Parts = list[tuple[CostPart, tuple[str, ...]]]
"""Blocks of a cost, each with the scenarios in which it is due, and objects of its variables."""


class _CostLaws:
    """The cost laws of ground actions; equal ones are mostly the same object."""

    def __init__(self, encoding: Encoding, handle: _relax.GroundProblem, limits: Limits) -> None:
        self.encoding = encoding
        self.handle = handle
        self.limits = limits
        self.problem = encoding.problem
        self.values = encoding.problem.function_values
        self.unit_costs = encoding.problem.domain.has_unit_costs
        self.shared: dict[tuple[int, tuple[CostPart, ...]], CostLaw] = {}
        self.always: dict[int, Parts] = {}  # by schema: those without condition and variables
        self.missing: dict[str, MissingNumber] = {}

    def all(self) -> tuple[tuple[CostLaw, ...], tuple[CostLaw, ...]]:
        """Return the law of what is always due of every action's cost, and that of every conditional part."""
        free = CostDistribution.certain(0.0)
        laws: list[CostLaw] = []
        part_laws: list[CostLaw] = []
        for number, schema in enumerate(self.handle.action_schema):
            if number % 1024 == 0:
                self.limits.check()
            action = self.encoding.actions[schema]
            if action is None:
                laws.append(free)
                continue
            if any(block.external for block in action.costs):
                self.limits.check()  # a callable may take its time
            laws.append(self.base_law(number, schema, action))
            for part in range(*self.handle.cost_parts(number)):
                if part % 1024 == 0:
                    self.limits.check()
                parts = self.read_parts(schema, self.handle.cost_part_blocks(part))
                part_laws.append(self.law(number, schema, action, parts))
        self.warn_of_missing_numbers()
        return tuple(laws), tuple(part_laws)

    def base_law(self, number: int, schema: int, action: Action) -> CostLaw:
        if self.unit_costs:
            return UNIT_COST
        if schema not in self.always:
            self.always[schema] = [
                (CostPart(index, None), ()) for index, block in enumerate(action.costs) if is_unconditional(block)
            ]
        parts = self.read_parts(schema, self.handle.action_cost_blocks(number))
        return self.law(number, schema, action, self.always[schema] + parts)

    def law(self, number: int, schema: int, action: Action, parts: Parts) -> CostLaw:
        key = (schema, tuple(part for part, _ in parts))
        law = self.shared.get(key)
        if law is None:
            arguments = self.objects(self.handle.action_arguments(number))
            blocks = self.in_each_scenario(parts)
            try:
                law = sum_of_blocks(action, arguments, blocks, self.problem)
            except MissingNumber:
                law = self.known_law(action, arguments, blocks)
            if all(_is_the_same_for_all(action.costs[part.block]) for part, _ in parts):
                self.shared[key] = law
        return law

    def in_each_scenario(self, parts: Parts) -> list[Blocks]:
        """Return the blocks that are due in each scenario; once, where there are none."""
        return [
            [(part.block, objects) for part, objects in parts if part.scenarios is None or scenario in part.scenarios]
            for scenario in range(len(self.problem.scenarios) or 1)
        ]

    def known_law(self, action: Action, arguments: tuple[str, ...], blocks: list[Blocks]) -> CostLaw:
        """Return the law of blocks of which some need missing numbers."""
        scenarios = self.problem.scenarios
        hidden = [scenario.facts for scenario in scenarios] or [frozenset()]
        laws = [self.known_part(action, arguments, *pair) for pair in zip(blocks, hidden, strict=True)]
        return by_scenario(scenarios, laws)

    def known_part(
        self, action: Action, arguments: tuple[str, ...], blocks: Blocks, hidden: frozenset[Fact]
    ) -> CostLaw:
        """Return the law of the blocks that need no missing number, and that of one that does."""
        known: Blocks = []
        laws: list[CostLaw] = []
        for index, objects in blocks:
            try:
                block_law(action.costs[index], action, arguments, objects, self.values, hidden)
            except MissingNumber as error:
                self.missing.setdefault(error.message, error)
                laws = [UnknownCost(error=error)]
            else:
                known.append((index, objects))
        if known:
            laws.append(sum_in_scenario(action, arguments, known, self.values, hidden))
        return CostSum(tuple(laws)) if len(laws) > 1 else laws[0]

    def warn_of_missing_numbers(self) -> None:
        if self.missing:
            first = next(iter(self.missing.values()))
            others = f" ({len(self.missing) - 1} more like it)" if len(self.missing) > 1 else ""
            until = "this cost is taken as 0, which is an error only if the best plan has it"
            warnings.warn(f"{first}; {until}{others}", CostWarning, stacklevel=2)

    def read_parts(self, schema: int, record: list[int]) -> Parts:
        parts: Parts = []
        at = 0
        while at < len(record):
            index, count = record[at : at + 2]
            parts.append((self.encoding.cost_parts[schema][index], self.objects(record[at + 2 : at + 2 + count])))
            at += 2 + count
        return parts

    def objects(self, numbers: list[int]) -> tuple[str, ...]:
        return tuple(self.encoding.objects[number] for number in numbers)


def _is_the_same_for_all(block: CostBlock) -> bool:
    """Tell whether a block has the same law for all arguments and objects."""

    def is_constant(expression: Expression) -> bool:
        match expression:
            case FunctionTerm(_, arguments):
                return not arguments
            case Arithmetic(_, operands):
                return all(map(is_constant, operands))
        return True

    return block.external is None and all(is_constant(expression) for branch in block.branches for expression in branch)
