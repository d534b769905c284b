"""The outcomes of ground actions: which branches of which blocks they stand for, and how likely they are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import statehtn._relax as _relax
from statehtn.core.encode import Encoding
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
    """

    def __init__(self, encoding: Encoding, handle: _relax.GroundProblem) -> None:
        self._encoding = encoding
        self._handle = handle
        self._schemas = handle.action_schema
        self._known: dict[tuple[int, tuple[str, ...], int, tuple[str, ...]], tuple[Fraction, ...]] = {}

    def combinations(self, action: int) -> tuple[Combination, ...]:
        """Return the combinations of branches any of which is this outcome; none for an action without outcomes."""
        record = self._handle.action_branches(action)
        found: list[Combination] = []
        at = 0
        while at < len(record):
            count, at = record[at], at + 1
            chosen = []
            for _ in range(count):
                block, branch, size = record[at : at + 3]
                objects = record[at + 3 : at + 3 + size]
                chosen.append(ChosenBranch(block, branch, tuple(self._encoding.objects[number] for number in objects)))
                at += 3 + size
            found.append(tuple(chosen))
        return tuple(found)

    def probability(self, action: int, combination: Combination) -> Fraction:
        """Return the probability of one of an action's combinations, exactly.

        Raises:
            InputError: a probability is none; the message names the action.
        """
        return math.prod((self._of(action, chosen)[chosen.branch] for chosen in combination), start=Fraction(1))

    def probabilities(self) -> tuple[Fraction, ...]:
        """Return by ground action how likely it is that this outcome comes, exactly; 1 without several outcomes.

        Raises:
            InputError: a probability is none; the message names the action.
        """
        certain = Fraction(1)
        if not self._encoding.problem.domain.has_outcomes:
            return (certain,) * len(self._schemas)
        found = []
        for action in range(len(self._schemas)):
            ways = self.combinations(action)
            found.append(sum((self.probability(action, way) for way in ways), Fraction(0)) if ways else certain)
        return tuple(found)

    def _of(self, action: int, chosen: ChosenBranch) -> tuple[Fraction, ...]:
        """Return the probabilities of all branches of the block from which one was chosen."""
        schema = self._schemas[action]
        arguments = tuple(self._encoding.objects[number] for number in self._handle.action_arguments(action))
        key = schema, arguments, chosen.block, chosen.objects
        if key not in self._known:
            lifted = self._encoding.actions[schema]
            assert lifted is not None
            block = lifted.outcomes[chosen.block]
            values = self._encoding.problem.function_values
            self._known[key] = branch_probabilities(block, lifted, arguments, chosen.objects, values)
        return self._known[key]
