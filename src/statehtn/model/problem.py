"""The lifted cost-variable HTN problem: immutable, and free of any syntax."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from graphlib import TopologicalSorter
from itertools import chain

from statehtn.model.chance import Chance, Scenario, scenario_count, scenarios_of
from statehtn.model.cost.blocks import CostBlock, Expression, FunctionValues
from statehtn.model.effect import Effect as Effect
from statehtn.model.formula import TRUE, Formula
from statehtn.model.formula import Fact as Fact
from statehtn.model.outcome import OutcomeBlock
from statehtn.model.types import Parameter, TypeHierarchy


@dataclass(frozen=True, slots=True)
class Signature:
    """A name with typed parameters: a predicate, a function or a compound task."""

    name: str
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True)
class Action:
    """A primitive task: a cost-variable operator (paper Definition 4.4).

    Args:
        name: the action's name.
        parameters: its variables.
        precondition: what must hold before it.
        effects: what it does for certain.
        costs: what it costs in any case, in independent parts.
        outcomes: what it does by chance, in independent blocks.
    """

    name: str
    parameters: tuple[Parameter, ...] = ()
    precondition: Formula = TRUE
    effects: tuple[Effect, ...] = ()
    costs: tuple[CostBlock, ...] = ()
    outcomes: tuple[OutcomeBlock, ...] = ()

    @cached_property
    def all_effects(self) -> tuple[Effect, ...]:
        """What it does for certain, then what it does in its outcomes, under the conditions of their blocks."""
        chosen = (block.effects_of(outcome) for block in self.outcomes for outcome in block.outcomes)
        return (*self.effects, *chain.from_iterable(chosen)) if self.outcomes else self.effects

    @cached_property
    def all_costs(self) -> tuple[CostBlock, ...]:
        """What it costs in any case, then what it costs in its outcomes, under the conditions of their blocks."""
        chosen = (block.costs_of(outcome) for block in self.outcomes for outcome in block.outcomes)
        return (*self.costs, *chain.from_iterable(chosen)) if self.outcomes else self.costs

    @property
    def expressions(self) -> Iterator[Expression]:
        """The expressions of its costs and of all probabilities."""
        yield from (cost for block in self.all_costs for _, cost in block.branches)
        yield from self.probabilities

    @property
    def probabilities(self) -> Iterator[Expression]:
        """The probabilities in its costs and of its outcomes."""
        yield from (probability for block in self.all_costs for probability, _ in block.branches)
        yield from (outcome.probability for block in self.outcomes for outcome in block.outcomes)


@dataclass(frozen=True, slots=True)
class Subtask:
    """An occurrence of a task, primitive or compound, in a task network; its label is unique there."""

    label: str
    task: str
    arguments: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class TaskNetwork:
    """Tasks and their order: pairs (i, j) of indices into `subtasks`, i before j; acyclic, not necessarily transitive.

    `constraints` is a formula over `Equals` and `OfType` only.
    """

    subtasks: tuple[Subtask, ...] = ()
    ordering: tuple[tuple[int, int], ...] = ()
    constraints: Formula = TRUE

    def predecessors(self) -> list[list[int]]:
        """Return for each subtask those that are ordered before it."""
        found: list[list[int]] = [[] for _ in self.subtasks]
        for before, after in self.ordering:
            found[after].append(before)
        return found

    def topological_order(self) -> list[int]:
        """Return the subtasks in an order that the network allows."""
        return list(TopologicalSorter(dict(enumerate(self.predecessors()))).static_order())


@dataclass(frozen=True, slots=True)
class Method:
    """One way to decompose the compound task `task(arguments)` into a network; its parameters bind all variables."""

    name: str
    parameters: tuple[Parameter, ...]
    task: str
    arguments: tuple[str, ...]
    network: TaskNetwork = TaskNetwork()
    precondition: Formula = TRUE


@dataclass(frozen=True)
class Domain:
    """What problems share. Mappings are by name, in order of declaration; `constants` maps an object to its type."""

    name: str
    types: TypeHierarchy = TypeHierarchy()
    constants: Mapping[str, str] = field(default_factory=dict)
    predicates: Mapping[str, Signature] = field(default_factory=dict)
    functions: Mapping[str, Signature] = field(default_factory=dict)
    tasks: Mapping[str, Signature] = field(default_factory=dict)
    actions: Mapping[str, Action] = field(default_factory=dict)
    methods: Mapping[str, Method] = field(default_factory=dict)

    @cached_property
    def has_unit_costs(self) -> bool:
        """True where no action states a cost: then every action costs 1."""
        return not any(action.all_costs for action in self.actions.values())

    @cached_property
    def has_outcomes(self) -> bool:
        """True where an action changes facts by chance."""
        return any(action.outcomes for action in self.actions.values())

    def __hash__(self) -> int:
        return hash((self.name, frozenset(self.actions), frozenset(self.methods), frozenset(self.tasks)))

    def __repr__(self) -> str:
        counts = f"actions {len(self.actions)}, tasks {len(self.tasks)}, methods {len(self.methods)}"
        return f"<domain '{self.name}': {counts}>"


@dataclass(frozen=True)
class Problem:
    """An HTN problem: initial state, initial task network and goal over a domain.

    Args:
        name: the problem's name.
        domain: types, predicates, tasks, actions with their costs, and methods.
        objects: the problem's own objects with their types; constants of the domain are not repeated.
        parameters: variables of the initial network, to be bound to any objects.
        network: the tasks to accomplish, and their order.
        initial_state: the facts that are true; all others are false, but for hidden ones.
        function_values: values for cost expressions.
        goal: a formula over facts that must hold in the end, besides the network being accomplished.
        chances: what is decided by chance before a plan begins and is never seen: hidden facts, which only conditions
            of costs read.
    """

    name: str
    domain: Domain
    objects: Mapping[str, str] = field(default_factory=dict)
    parameters: tuple[Parameter, ...] = ()
    network: TaskNetwork = TaskNetwork()
    initial_state: frozenset[Fact] = frozenset()
    function_values: FunctionValues = field(default_factory=dict)
    goal: Formula = TRUE
    chances: tuple[Chance, ...] = ()

    @cached_property
    def scenarios(self) -> tuple[Scenario, ...]:
        """What the chances may turn out to be together; none where nothing is decided by chance.

        Raises:
            UnsupportedError: there are too many.
        """
        return scenarios_of(self.chances)

    @cached_property
    def all_objects(self) -> dict[str, str]:
        """All objects, constants first, with their types."""
        return {**self.domain.constants, **self.objects}

    @cached_property
    def _objects_of(self) -> dict[tuple[str, ...], tuple[str, ...]]:
        return {}

    def objects_of(self, types: tuple[str, ...]) -> tuple[str, ...]:
        """Return the objects of any of the types, in order of declaration."""
        found = self._objects_of.get(types)
        if found is None:
            kinds = self.domain.types.subtypes(types)
            found = tuple(name for name, kind in self.all_objects.items() if kind in kinds)
            self._objects_of[types] = found
        return found

    def __hash__(self) -> int:
        return hash((self.name, self.domain, frozenset(self.objects.items()), self.initial_state, self.goal))

    def __repr__(self) -> str:
        counts = f"objects {len(self.all_objects)}, facts {len(self.initial_state)}, tasks {len(self.network.subtasks)}"
        if self.chances:
            counts += f", scenarios {scenario_count(self.chances)}"
        return f"<problem '{self.name}': {counts}; in {self.domain!r}>"
