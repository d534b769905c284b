"""Which outcomes a plan counts on that does not say so: those of the runs in which it can be executed, best first."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from heapq import heappop, heappush

from statehtn.model.formula import predicates
from statehtn.model.outcome import OutcomeBlock
from statehtn.model.plan import Step
from statehtn.model.problem import Effect, Fact, Problem
from statehtn.semantics.chances import StepOutcome
from statehtn.semantics.outcomes import Transitions
from statehtn.semantics.world import World

Price = Callable[[StepOutcome], float]
"""What it costs to count on an outcome: at least 0; prices add up along a plan."""
State = frozenset[Fact]


def likeliest(outcome: StepOutcome) -> float:
    """Return the price by which the likeliest run is the best one: minus the logarithm of the probability."""
    return max(0.0, -math.log(outcome.probability))


@dataclass(frozen=True, slots=True)
class _Run:
    """The first steps of a plan with an outcome of each: a list that ends with its last one."""

    facts: State
    length: int = 0
    last: StepOutcome | None = None
    before: _Run | None = None

    def outcomes(self) -> tuple[StepOutcome, ...]:
        found: list[StepOutcome] = []
        run: _Run | None = self
        while run is not None and run.last is not None:
            found.append(run.last)
            run = run.before
        return tuple(reversed(found))


class Trajectories:
    """The runs of a list of steps in which every step can be executed and the goal holds at the end.

    They are found in the order of their prices, as shortest paths are, by states and steps. Where only the first one
    is asked for, a state is looked at once at each step.

    Args:
        steps: of a plan.
        world: the problem, and limits.
        seen: facts by which outcomes are told apart; None for all facts.
        price: of counting on an outcome.
        is_first_alone: yield the best run alone.
    """

    def __init__(
        self, steps: Sequence[Step], world: World, seen: State | None, price: Price, is_first_alone: bool
    ) -> None:
        self.why_not = ""
        """Where no run is yielded: what stands in the way of the one that has come farthest."""
        self.farthest: tuple[StepOutcome, ...] = ()
        """The outcomes of that one."""
        self._steps = steps
        self._world = world
        self._transitions = Transitions(world, seen)
        self._price = price
        self._is_first_alone = is_first_alone

    def __iter__(self) -> Iterator[tuple[StepOutcome, ...]]:
        count, most = 0, -1
        known: set[tuple[int, State]] = set()
        heap = [(0.0, 0, 0, _Run(self._world.problem.initial_state))]
        while heap:
            self._world.work()
            price, _, _, run = heappop(heap)
            if self._is_first_alone and (run.length, run.facts) in known:
                continue
            known.add((run.length, run.facts))
            wrong = self._wrong(run)
            if wrong is not None and run.length > most:
                most, self.why_not, self.farthest = run.length, wrong, run.outcomes()
            elif wrong is None and run.length == len(self._steps):
                yield run.outcomes()
                if self._is_first_alone:
                    return
            elif wrong is None:
                for outcome in self._transitions.outcomes(self._steps[run.length], run.facts, as_stated=True) or ():
                    count += 1
                    after = _Run(outcome.after(run.facts), run.length + 1, outcome, run)
                    heappush(heap, (price + self._price(outcome), -after.length, count, after))

    def _wrong(self, run: _Run) -> str | None:
        """Say why a run cannot go on, or does not end well; None if it can, or does."""
        if run.length < len(self._steps):
            step = self._steps[run.length]
            why = self._transitions.why_not(step, run.facts)
            why = None if why is None else f"step {run.length + 1} {step}: {why}"
        else:
            why = self._transitions.why_no_goal(run.facts)
            why = None if why is None else f"the goal does not hold in the end: {why}"
        has_choice = any(outcome.probability < 1 for outcome in run.outcomes()) if why is not None else False
        return f"{why}, and no outcomes of the steps before lead farther" if has_choice else why


def without_unread(problem: Problem) -> Problem:
    """Return a problem whose actions do not change what nothing reads: that tells no two outcomes apart.

    In all else it is the same, so that plans of the one are plans of the other.
    """
    read = set(_read(problem))

    def kept(effects: tuple[Effect, ...]) -> tuple[Effect, ...]:
        return tuple(effect for effect in effects if effect.atom.predicate in read)

    def kept_of(block: OutcomeBlock) -> OutcomeBlock:
        return replace(block, outcomes=tuple(replace(each, effects=kept(each.effects)) for each in block.outcomes))

    domain = problem.domain
    actions = {
        name: replace(action, effects=kept(action.effects), outcomes=tuple(map(kept_of, action.outcomes)))
        for name, action in domain.actions.items()
    }
    return replace(problem, domain=replace(domain, actions=actions))


def _read(problem: Problem) -> Iterator[str]:
    """Yield the predicates that conditions read, with repetitions."""
    domain = problem.domain
    yield from predicates(problem.goal)
    for network in (problem.network, *(method.network for method in domain.methods.values())):
        yield from predicates(network.constraints)
    for method in domain.methods.values():
        yield from predicates(method.precondition)
    for action in domain.actions.values():
        yield from predicates(action.precondition)
        by_chance = (effect for block in action.outcomes for each in block.outcomes for effect in each.effects)
        for effect in (*action.effects, *by_chance):
            yield from predicates(effect.condition)
        for cost in action.all_costs:
            yield from predicates(cost.condition)
        for block in action.outcomes:
            yield from predicates(block.condition)
