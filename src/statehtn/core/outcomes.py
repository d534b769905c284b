"""The outcomes of ground actions: which branches of which blocks they stand for, and how likely they are."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

import statehtn._relax as _relax
from statehtn.core.encode import Encoding
from statehtn.limits import Limits
from statehtn.model import Action
from statehtn.model.cost.expressions import constant_value
from statehtn.model.ground_outcome import branch_probabilities


@dataclass(frozen=True, slots=True)
class ChosenBranch:
    """A branch of a block of outcomes, chosen for one binding of the block's variables.

    Args:
        block: in `Action.outcomes`.
        branch: in `OutcomeBlock.branches`.
        objects: of the block's variables.
    """

    block: int
    branch: int
    objects: tuple[str, ...]


Combination = tuple[ChosenBranch, ...]
"""What is chosen in all blocks of an action together."""


class Outcomes:
    """The outcomes of the actions of a ground problem.

    Args:
        encoding: what the core's numbers mean.
        handle: the ground problem in the core.
        limits: of working them out.
    """

    def __init__(self, encoding: Encoding, handle: _relax.GroundProblem, limits: Limits) -> None:
        self._encoding = encoding
        self._handle = handle
        self._limits = limits
        self._schemas = handle.action_schema
        self._of_blocks: dict[tuple[int, tuple[str, ...], int, tuple[str, ...]], tuple[Fraction, ...]] = {}
        self._of_records: dict[
            tuple[int, ...], Fraction
        ] = {}  # of actions for all of whose instances they are the same
        self._is_the_same: dict[int, bool] = {}  # by schema

    def combinations(self, action: int) -> tuple[Combination, ...]:
        """Return the combinations of branches any of which is this outcome; none for an action without outcomes."""
        return tuple(self._read(self._handle.action_branches(action)))

    def is_mixture(self, action: int) -> bool:
        """Tell whether several combinations of branches are this outcome, so that its cost is a mixture."""
        record = self._handle.action_branches(action)
        at = 1
        for _ in range(record[0] if record else 0):
            at += 3 + record[at + 2]
        return at < len(record)

    def probability(self, action: int, combination: Combination) -> Fraction:
        """Return the probability of one of an action's combinations, exactly.

        Raises:
            InputError: a probability is none; the message names the action.
        """
        factors = [self._of(action, chosen)[chosen.branch] for chosen in combination] or [Fraction(1)]
        return math.prod(factors[1:], start=factors[0])

    def probabilities(self) -> tuple[Fraction, ...]:
        """Return by ground action how likely it is that this outcome comes, exactly; 1 without several outcomes.

        Raises:
            InputError: a probability is none; the message names the action.
            LimitReached: a limit is reached.
        """
        certain = Fraction(1)
        if not self._encoding.problem.domain.has_outcomes:
            return (certain,) * len(self._schemas)
        found = []
        for action, schema in enumerate(self._schemas):
            if action % 1024 == 0:
                self._limits.check()
            lifted = self._encoding.actions[schema]
            if lifted is None or not lifted.outcomes:
                found.append(certain)
                continue
            record = self._handle.action_branches(action)
            key = (schema, *record) if self._has_constants(schema, lifted) else None
            known = None if key is None else self._of_records.get(key)
            if known is None:
                ways = [self.probability(action, way) for way in self._read(record)]
                known = sum(ways[1:], ways[0]) if ways else certain
                if key is not None:
                    self._of_records[key] = known
            found.append(known)
        return tuple(found)

    def _has_constants(self, schema: int, action: Action) -> bool:
        """Tell whether all probabilities of an action are numbers."""
        if schema not in self._is_the_same:
            expressions = (outcome.probability for block in action.outcomes for outcome in block.outcomes)
            self._is_the_same[schema] = all(constant_value(expression) is not None for expression in expressions)
        return self._is_the_same[schema]

    def _read(self, record: list[int]) -> Iterator[Combination]:
        """Yield what a row of `action_branches` says."""
        at = 0
        while at < len(record):
            count, at = record[at], at + 1
            chosen = []
            for _ in range(count):
                block, branch, size = record[at : at + 3]
                objects = record[at + 3 : at + 3 + size]
                chosen.append(ChosenBranch(block, branch, tuple(self._encoding.objects[number] for number in objects)))
                at += 3 + size
            yield tuple(chosen)

    def _of(self, action: int, chosen: ChosenBranch) -> tuple[Fraction, ...]:
        """Return the probabilities of all branches of the block from which one was chosen."""
        schema = self._schemas[action]
        arguments = tuple(self._encoding.objects[number] for number in self._handle.action_arguments(action))
        key = schema, arguments, chosen.block, chosen.objects
        if key not in self._of_blocks:
            lifted = self._encoding.actions[schema]
            assert lifted is not None
            block = lifted.outcomes[chosen.block]
            values = self._encoding.problem.function_values
            self._of_blocks[key] = branch_probabilities(block, lifted, arguments, chosen.objects, values)
        return self._of_blocks[key]
