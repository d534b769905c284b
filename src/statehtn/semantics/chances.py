"""What chance may choose of an action in a state, by the lifted model alone."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.scenario_cost import mixed
from statehtn.model.ground_outcome import branch_probabilities
from statehtn.model.outcome import OutcomeBlock
from statehtn.model.problem import Action, Fact
from statehtn.semantics.condition import Condition
from statehtn.semantics.due import DueParts, changes_of, due_parts
from statehtn.semantics.formulas import Bindings
from statehtn.semantics.history import State
from statehtn.semantics.world import World


@dataclass(frozen=True, slots=True)
class StepOutcome:
    """One of the things that may come of a step in a state.

    Args:
        probability: exactly, above 0.
        added: the facts that become true and were not; or all that it makes true, where outcomes are told apart so.
        deleted: the facts that become false and were true; or all that it makes false.
        law: of the cost, given that this outcome comes.
    """

    probability: Fraction
    added: frozenset[Fact]
    deleted: frozenset[Fact]
    law: CostLaw

    def after(self, facts: frozenset[Fact]) -> frozenset[Fact]:
        """Return the state after the step."""
        return facts - self.deleted | self.added


@dataclass(frozen=True, slots=True)
class Chosen:
    """What is certain of an action or was chosen so far: what it adds, what it deletes, and costs in each scenario."""

    added: frozenset[Fact]
    deleted: frozenset[Fact]
    due: tuple[DueParts, ...]

    def __and__(self, other: Chosen) -> Chosen:
        due = tuple((*mine, *its) for mine, its in zip(self.due, other.due, strict=True))
        return Chosen(self.added | other.added, self.deleted | other.deleted, due)


class LiftedBlock:
    """A block of outcomes with its formulas compiled.

    Args:
        block: one of `action.outcomes`.
        action: the action.
        first_cost: the index in `Action.all_costs` of its first cost.
        world: the objects and their types.
    """

    def __init__(self, block: OutcomeBlock, action: Action, first_cost: int, world: World) -> None:
        self._block = block
        self._action = action
        self._values = world.problem.function_values
        self._condition = Condition(block.condition, world)
        self._branches = []
        for outcome in block.branches:
            effects = [(effect, Condition(effect.condition, world)) for effect in outcome.effects]
            costs = [(index, c, Condition(c.condition, world)) for index, c in enumerate(outcome.costs, first_cost)]
            first_cost += len(costs)
            self._branches.append((effects, costs))
        self._probabilities: dict[tuple[str, ...], tuple[Fraction, ...]] = {}

    @staticmethod
    def all(action: Action, world: World) -> Iterator[LiftedBlock]:
        """Yield the blocks of an action."""
        first_cost = len(action.costs)
        for block in action.outcomes:
            yield LiftedBlock(block, action, first_cost, world)
            first_cost += sum(len(outcome.costs) for outcome in block.outcomes)

    def bindings(self, bindings: Bindings, state: State) -> Iterator[Bindings]:
        """Yield, each once, the bindings of the block's variables for which it is due, with those of the action."""
        return self._condition.solutions(self._block.parameters, bindings, state)

    def branches(
        self,
        arguments: tuple[str, ...],
        bindings: Bindings,
        state: State,
        hidden: Sequence[State],
        seen: frozenset[Fact] | None,
    ) -> list[tuple[Fraction, Chosen]]:
        """Return the branches that can be chosen for one binding, each with its probability.

        Args:
            arguments: of the action.
            bindings: of the action's and the block's variables.
            state: before the action.
            hidden: the same state with the hidden facts of each scenario.
            seen: leave out changes of other facts; None for no others.
        """
        objects = tuple(bindings[parameter.name] for parameter in self._block.parameters)
        key = (*arguments, *objects)
        if key not in self._probabilities:
            probabilities = branch_probabilities(self._block, self._action, arguments, objects, self._values)
            self._probabilities[key] = probabilities
        found = []
        for probability, (effects, costs) in zip(self._probabilities[key], self._branches, strict=True):
            if not probability:
                continue
            added, deleted = changes_of(effects, bindings, state)
            if seen is not None:
                added, deleted = added & seen, deleted & seen
            due = tuple(due_parts(costs, bindings, one, objects) for one in hidden)
            found.append((probability, Chosen(added, deleted, due)))
        return found


def combined(
    certain: Chosen, instances: Iterable[list[tuple[Fraction, Chosen]]], world: World
) -> dict[Chosen, Fraction]:
    """Return what may be chosen of all instances together, which are independent, with the probabilities."""
    found = {certain: Fraction(1)}
    for branches in instances:
        wider: dict[Chosen, Fraction] = {}
        for chosen, probability in found.items():
            for weight, branch in branches:
                world.work()
                both = chosen & branch
                wider[both] = wider.get(both, Fraction(0)) + probability * weight
        found = wider
    return found


def merged(
    found: dict[Chosen, Fraction], before: set[Fact] | None, law: Callable[[tuple[DueParts, ...]], CostLaw]
) -> tuple[StepOutcome, ...]:
    """Return outcomes of which each leads to another state; the law of one is the mixture over what leads there.

    Args:
        found: what may be chosen.
        before: the facts that are true before the step; None to tell outcomes apart by what they make true and false,
            even if it is so already.
        law: of the cost, where these parts of it are due in each scenario.
    """
    ways: dict[tuple[frozenset[Fact], frozenset[Fact]], list[tuple[Fraction, CostLaw]]] = {}
    for chosen, probability in found.items():
        changes = chosen.added, chosen.deleted - chosen.added
        if before is not None:
            changes = changes[0] - before, changes[1] & before
        ways.setdefault(changes, []).append((probability, law(chosen.due)))
    return tuple(
        StepOutcome(
            sum((probability for probability, _ in pairs), Fraction(0)),
            *changes,
            mixed([float(probability) for probability, _ in pairs], [given for _, given in pairs]),
        )
        for changes, pairs in ways.items()
    )
