"""The cost laws of ground actions, of what is always due of them and of their conditional parts."""

from __future__ import annotations

import statehtn._relax as _relax
from statehtn.core.encode import CostPart, Encoding
from statehtn.core.outcomes import Combination, Outcomes
from statehtn.limits import Limits
from statehtn.log import warn_caller
from statehtn.model import (
    CostBlock,
    CostDistribution,
    CostLaw,
    CostSum,
)
from statehtn.model.cost.blocks import Arithmetic, Expression, FunctionTerm
from statehtn.model.cost.ground_cost import (
    UNIT_COST,
    block_law,
    is_unconditional,
    sum_in_scenario,
    sum_of_blocks,
)
from statehtn.model.cost.probabilities import CostWarning
from statehtn.model.cost.scenario_cost import by_scenario, mixed
from statehtn.model.cost.unknown import MissingNumber, UnknownCost
from statehtn.model.problem import Action, Fact

Blocks = list[tuple[int, tuple[str, ...]]]
"""Blocks of a cost: (index in `Action.all_costs`, objects of its variables)."""
Parts = list[tuple[CostPart, tuple[str, ...]]]
"""Blocks of a cost, each with the scenarios in which it is due, and objects of its variables."""


class CostLaws:
    """The cost laws of ground actions; equal ones are mostly the same object."""

    def __init__(self, encoding: Encoding, handle: _relax.GroundProblem, outcomes: Outcomes, limits: Limits) -> None:
        self.encoding = encoding
        self.handle = handle
        self.outcomes = outcomes
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
            if any(block.external for block in action.all_costs):
                self.limits.check()  # a callable may take its time
            laws.append(self._base_law(number, schema, action))
            for part in range(*self.handle.cost_parts(number)):
                if part % 1024 == 0:
                    self.limits.check()
                parts = self._read_parts(schema, self.handle.cost_part_blocks(part))
                part_laws.append(self._law(number, schema, action, parts))
        self._warn_of_missing_numbers()
        return tuple(laws), tuple(part_laws)

    def _base_law(self, number: int, schema: int, action: Action) -> CostLaw:
        if self.unit_costs:
            return UNIT_COST
        if schema not in self.always:
            self.always[schema] = [
                (CostPart(index, None), ()) for index, block in enumerate(action.costs) if is_unconditional(block)
            ]
        always = self.always[schema]
        parts = self._read_parts(schema, self.handle.action_cost_blocks(number))
        if not (action.outcomes and self.outcomes.is_mixture(number)):
            return self._law(number, schema, action, always + parts)
        combinations = self.outcomes.combinations(number)
        chosen = [[pair for pair in parts if _is_due(*pair, combination)] for combination in combinations]
        laws = [self._law(number, schema, action, always + due) for due in chosen]
        weights = [float(self.outcomes.probability(number, combination)) for combination in combinations]
        return mixed(weights, laws) if any(weights) else laws[0]

    def _law(self, number: int, schema: int, action: Action, parts: Parts) -> CostLaw:
        key = (schema, tuple(part for part, _ in parts))
        law = self.shared.get(key)
        if law is None:
            arguments = self._objects(self.handle.action_arguments(number))
            blocks = self._in_each_scenario(parts)
            try:
                law = sum_of_blocks(action, arguments, blocks, self.problem)
            except MissingNumber:
                law = self._known_law(action, arguments, blocks)
            if all(_is_the_same_for_all(action.all_costs[part.block]) for part, _ in parts):
                self.shared[key] = law
        return law

    def _in_each_scenario(self, parts: Parts) -> list[Blocks]:
        """Return the blocks that are due in each scenario; once, where there are none."""
        return [
            [(part.block, objects) for part, objects in parts if part.scenarios is None or scenario in part.scenarios]
            for scenario in range(len(self.problem.scenarios) or 1)
        ]

    def _known_law(self, action: Action, arguments: tuple[str, ...], blocks: list[Blocks]) -> CostLaw:
        """Return the law of blocks of which some need missing numbers."""
        scenarios = self.problem.scenarios
        hidden = [scenario.facts for scenario in scenarios] or [frozenset()]
        laws = [self._known_part(action, arguments, *pair) for pair in zip(blocks, hidden, strict=True)]
        return by_scenario(scenarios, laws)

    def _known_part(
        self, action: Action, arguments: tuple[str, ...], blocks: Blocks, hidden: frozenset[Fact]
    ) -> CostLaw:
        """Return the law of the blocks that need no missing number, and that of one that does."""
        known: Blocks = []
        laws: list[CostLaw] = []
        for index, objects in blocks:
            try:
                block_law(action.all_costs[index], action, arguments, objects, self.values, hidden)
            except MissingNumber as error:
                self.missing.setdefault(error.message, error)
                laws = [UnknownCost(error=error)]
            else:
                known.append((index, objects))
        if known:
            laws.append(sum_in_scenario(action, arguments, known, self.values, hidden))
        return CostSum(tuple(laws)) if len(laws) > 1 else laws[0]

    def _warn_of_missing_numbers(self) -> None:
        if self.missing:
            first = next(iter(self.missing.values()))
            others = f" ({len(self.missing) - 1} more like it)" if len(self.missing) > 1 else ""
            until = "this cost is taken as 0, which is an error only if the best plan has it"
            warn_caller(CostWarning(f"{first}; {until}{others}"))

    def _read_parts(self, schema: int, record: list[int]) -> Parts:
        parts: Parts = []
        at = 0
        while at < len(record):
            index, count = record[at : at + 2]
            parts.append((self.encoding.cost_parts[schema][index], self._objects(record[at + 2 : at + 2 + count])))
            at += 2 + count
        return parts

    def _objects(self, numbers: list[int]) -> tuple[str, ...]:
        return tuple(self.encoding.objects[number] for number in numbers)


def _is_due(part: CostPart, objects: tuple[str, ...], combination: Combination) -> bool:
    """Tell whether a part of a cost is due where these branches were chosen; its objects begin with the block's."""
    return part.branch is None or any(
        part.branch == (chosen.block, chosen.branch) and objects[: len(chosen.objects)] == chosen.objects
        for chosen in combination
    )


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
