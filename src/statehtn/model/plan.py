"""Plans with their decompositions; independent of how they were found."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import zip_longest
from typing import TYPE_CHECKING

from statehtn.counted import counted
from statehtn.errors import UsageError
from statehtn.expected import expect, items, whole_number
from statehtn.model.chance import Scenario
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.scenario_cost import ScenarioCost, sampled_total, total_by_scenario, total_of
from statehtn.model.formula import Fact
from statehtn.model.plan_outcome import PlanOutcome

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

    from statehtn.model.decomposition_tree import DecompositionTree


MOST_RUNS = 1_000_000_000
"""Of a plan that can be simulated at once."""


MOST_SHOWN = 5


@dataclass(frozen=True, slots=True)
class Step:
    """A ground primitive task in a plan: the name of its `action`, and its `arguments`, which are names of objects."""

    action: str
    arguments: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"({' '.join((self.action, *self.arguments))})"


@dataclass(frozen=True, slots=True, repr=False, eq=False)
class Decomposition:
    """A ground compound task, the method that decomposed it, and what became of the method's subtasks.

    `children` has one entry for each subtask of the method, in the method's own order: the index of the step in the
    plan for a primitive task, a `Decomposition` for a compound one. `arguments` are the task's. `bindings` are the
    method's arguments (one object per method parameter) where they are known; a plan read from a file does not tell.
    """

    task: str
    arguments: tuple[str, ...]
    method: str
    children: tuple[int | Decomposition, ...] = ()
    bindings: tuple[str, ...] | None = None

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Decomposition):
            return NotImplemented
        # Node by node: decompositions may be deeper than Python's recursion allows.
        pairs = zip_longest(self.walk(), other.walk())
        return self is other or all(one and two and one._content() == two._content() for one, two in pairs)

    def __hash__(self) -> int:
        return hash((self.task, self.arguments, self.method, len(self.children)))

    def _content(self) -> tuple[object, ...]:
        """Return what this node says itself: of compound subtasks only where they stand."""
        children = tuple(child if isinstance(child, int) else None for child in self.children)
        return self.task, self.arguments, self.method, children, self.bindings

    def __repr__(self) -> str:
        return f"<decomposition of ({' '.join((self.task, *self.arguments))}) by {self.method}>"

    def walk(self) -> Iterator[Decomposition]:
        """Yield this node and all compound nodes below it, parents first."""
        pending = [self]
        while pending:
            node = pending.pop()
            yield node
            pending.extend(child for child in reversed(node.children) if isinstance(child, Decomposition))


@dataclass(frozen=True, slots=True, repr=False)
class Plan:
    """A sequence of actions and the decomposition of the initial network that it comes from.

    `steps` are the actions, in the order of their execution: those of the domain only.
    `roots` has one entry for each task of the initial network, in its order, as in `Decomposition.children`.
    `root_bindings` binds the initial network's parameters (empty where there are none, None where unknown).
    `costs` has the law of each step's cost in the state it is executed in; None where they are not known, as in a plan
    that was read from a file. Plans that only differ in it are equal.
    `outcomes` has what a plan counts on that each step leads to, where actions have several outcomes; else None.
    `seen` has the facts by which outcomes are told apart there.
    """

    steps: tuple[Step, ...] = ()
    roots: tuple[int | Decomposition, ...] = ()
    root_bindings: tuple[str, ...] | None = ()
    costs: tuple[CostLaw, ...] | None = field(default=None, compare=False, repr=False)
    outcomes: tuple[PlanOutcome, ...] | None = field(default=None, repr=False)
    seen: frozenset[Fact] | None = field(default=None, compare=False, repr=False)

    def __repr__(self) -> str:
        shown = [str(step) for step in self.steps[:MOST_SHOWN]]
        more = ["..."] if len(self.steps) > MOST_SHOWN else []
        return f"<plan of {counted(len(self.steps), 'step')}: {' '.join(shown + more)}>"

    @property
    def decomposition(self) -> DecompositionTree:
        """The decomposition as a tree to print, to show in a notebook and to draw."""
        from statehtn.model.decomposition_tree import DecompositionTree  # which knows plans

        return DecompositionTree(self)

    def decompositions(self) -> Iterator[Decomposition]:
        """Yield all compound nodes, parents first."""
        for root in self.roots:
            if isinstance(root, Decomposition):
                yield from root.walk()

    def with_costs(self, costs: Sequence[CostLaw]) -> Plan:
        """Return the plan with the law of each step's cost, such as `statehtn.validate(problem, plan).costs`.

        Raises:
            UsageError: there is not one for each step.
        """
        laws = tuple(expect(law, CostLaw, "expected the law of each step's cost") for law in items(costs, "the costs"))
        if len(laws) != len(self.steps):
            raise UsageError(f"a plan of {counted(len(self.steps), 'step')} needs a cost for each, found {len(laws)}")
        return replace(self, costs=laws)

    def cost_distribution(self) -> CostLaw:
        """Return the law of the plan's total cost: positive, in the domain's unit.

        The actions' costs are independent; where some depend on hidden facts, they are so given each scenario, and this
        is the exact mixture over all scenarios.

        It is a `CostDistribution`, exact, where the actions' costs are lists of outcomes and their sum has not more
        than 20,000 different values; the action's own law where only one of them costs anything; otherwise a
        `TotalCost` on a grid that knows its error. See `statehtn.model.cost.sum`.

        Raises:
            UsageError: the plan does not know what its steps cost.
        """
        return total_of(self._known_costs())

    def cost_distribution_given(self, scenario: Scenario | str | int) -> CostLaw:
        """Return the law of the plan's total cost where the hidden facts are those of a scenario.

        It is the law of the plan where none of its costs depends on them.

        Args:
            scenario: one of `problem.scenarios`, its name, or its number from 0.

        Raises:
            UsageError: the plan does not know what its steps cost, or there is no such scenario.
        """
        total = total_by_scenario(self._known_costs())
        return total.given(scenario) if isinstance(total, ScenarioCost) else total

    def simulate(self, runs: int, seed: int = 0) -> NDArray[float64]:
        """Return the total costs of so many independent runs of the plan, drawn by numpy's default generator.

        The same seed draws the same costs.

        Raises:
            UsageError: the plan does not know what its steps cost, or there is not at least one run.
        """
        import numpy

        if not 1 <= whole_number(runs, "the number of runs") <= MOST_RUNS:
            raise UsageError(f"the number of runs must be from 1 to {MOST_RUNS}, found {runs}")
        if whole_number(seed, "the seed") < 0:
            raise UsageError(f"the seed must be at least 0, found {seed}")
        return sampled_total(self._known_costs(), runs, numpy.random.default_rng(seed))

    def _known_costs(self) -> tuple[CostLaw, ...]:
        if self.costs is None:
            raise UsageError(
                "this plan does not know what its steps cost; plan.with_costs(statehtn.validate(problem, plan).costs) "
                "returns one that does"
            )
        return self.costs
