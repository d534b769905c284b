"""From the core's arrays of a policy to its decisions in the words of the domain."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import overload

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.policy_laws import BranchLaws
from statehtn.core.trace import TraceReader
from statehtn.model.plan import Plan, Step
from statehtn.model.policy_graph import Branch, Decision, End, FlatPolicy, PolicyGraph, PolicyNode
from statehtn.model.problem import Fact

_ENDS = {
    _relax.PolicyEnd.GoesOn: None,
    _relax.PolicyEnd.Done: End.DONE,
    _relax.PolicyEnd.NothingLeft: End.FAILED,
    _relax.PolicyEnd.GivesUp: End.GIVEN_UP,
}
CONDITION = "condition"
"""The name of a task of a network that stands for what must hold there: the precondition of a method, or the goal."""


class PolicyReader:
    """Reads the policy that a run in the core has found last, and must not be run again.

    Args:
        grounding: the ground problem.
        run: the run.
        laws: of what is paid on branches.
    """

    def __init__(self, grounding: Grounding, run: _relax.PolicyRun, laws: BranchLaws) -> None:
        self.grounding = grounding
        self.run = run
        self.laws = laws
        self._traces = TraceReader(grounding)
        self._facts: dict[int, Fact] = {}
        self._known: dict[tuple[int, ...], frozenset[Fact]] = {}

    @cached_property
    def flat(self) -> FlatPolicy:
        """What runs do and cost, without names."""
        run = self.run
        return FlatPolicy(
            [_ENDS[end] for end in run.ends], run.first, run.probabilities, self.laws.of_run(run), run.successors
        )

    @cached_property
    def _actions(self) -> list[int | None]:
        """The action of each branch: a list that is made once, since the core's own is copied for whoever asks."""
        return self.run.actions

    @cached_property
    def graph(self) -> PolicyGraph:
        """The policy; nodes are made when they are asked for."""
        return PolicyGraph(PolicyNodes(self), self.flat)

    def plan_of(self, branches: Sequence[int]) -> Plan:
        """Return the plan of a run, as branches from the root on, with its decomposition."""
        return self._traces.read(self.run.plan(branches))

    def node(self, number: int) -> PolicyNode:
        """Return a node in the words of the domain."""
        run, handle = self.run, self.grounding.handle
        holding, known = run.facts(number)
        facts = set(holding)
        tasks = run.tasks(number)
        end = self.flat.ends[number]
        return PolicyNode(
            frozenset(map(self._fact, facts)),
            tuple(map(self._task, tasks)),
            tuple(run.ordering(number)),
            None if end is not None else self._decision(number, tasks, facts, handle),
            end,
            self.laws.left(run, number),
            self._known_by(tuple(known)),
        )

    def _known_by(self, numbers: tuple[int, ...]) -> frozenset[Fact]:
        """Return facts; many nodes have the same ones."""
        if numbers not in self._known:
            self._known[numbers] = frozenset(map(self._fact, numbers))
        return self._known[numbers]

    def _decision(self, number: int, tasks: Sequence[int], facts: set[int], handle: _relax.GroundProblem) -> Decision:
        index, method = self.run.step(number)
        flat, actions = self.flat, self._actions
        branches = []
        for at in flat.branches(number):
            added, deleted = self._changes(actions[at], facts)
            branches.append(Branch(flat.probabilities[at], flat.laws[at], flat.successors[at], added, deleted))
        task = self._task(tasks[index]) if self._is_of_the_domain(tasks[index]) else None
        if method is None:
            return Decision(index, task, tuple(branches))
        parts = range(*handle.method_parts(method))
        lifted = self.grounding.encoding.schemes[handle.part_schema(parts.start)].method if parts else None
        name = lifted.name if lifted is not None else "initial network" if parts else "case"
        objects = self.grounding.objects(handle.part_arguments(parts.start)) if lifted is not None else ()
        return Decision(index, task, tuple(branches), name, objects)

    def _changes(self, action: int | None, facts: set[int]) -> tuple[frozenset[Fact], frozenset[Fact]]:
        """Return what an action makes true and false in a state; what is added wins."""
        handle = self.grounding.handle
        added, deleted = set[int](), set[int]()
        for effect in range(*handle.effects(action)) if action is not None else ():
            is_due = facts.issuperset(handle.effect_conditions(effect))
            if is_due and facts.isdisjoint(handle.effect_negative_conditions(effect)):
                added.update(handle.effect_adds(effect))
                deleted.update(handle.effect_deletes(effect))
        return (
            frozenset(map(self._fact, added - facts)),
            frozenset(map(self._fact, (deleted & facts) - added)),
        )

    def _fact(self, number: int) -> Fact:
        fact = self._facts.get(number)
        if fact is None:
            grounding, handle = self.grounding, self.grounding.handle
            name = grounding.encoding.predicates[handle.fact_predicate[number]]
            fact = self._facts[number] = (name, *grounding.objects(handle.fact_arguments(number)))
        return fact

    def _is_of_the_domain(self, task: int) -> bool:
        """Tell whether an action or a compound task is in the domain, not only in the ground problem."""
        return not self._is_condition(task) and " " not in self.grounding.task_name(self._schemas[task])

    def _is_condition(self, task: int) -> bool:
        """Tell whether a task is a precondition action, or the choice of one of several cases of it."""
        actions, schema = self.grounding.encoding.actions, self._schemas[task]
        return schema < len(actions) and actions[schema] is None

    @cached_property
    def _schemas(self) -> list[int]:
        """The lifted task of each ground one, actions first; a list that is made once, as `_actions`."""
        return [*self.grounding.handle.action_schema, *self.grounding.handle.compound_schema]

    def _task(self, number: int) -> Step:
        if self._is_condition(number):
            return Step(CONDITION, self._condition(number))
        grounding, handle = self.grounding, self.grounding.handle
        compound = number - handle.action_count
        arguments = handle.action_arguments(number) if compound < 0 else handle.compound_arguments(compound)
        return Step(grounding.task_name(self._schemas[number]), grounding.objects(arguments))

    def _condition(self, test: int) -> tuple[str, ...]:
        """Return what a precondition action, or the choice of one of several cases of it, asks for, as in HDDL.

        Equal preconditions of several methods are one action of the ground problem, whose own name is that of one of
        them and says nothing of the method that was chosen.
        """
        handle = self.grounding.handle
        if test >= handle.action_count:
            cases = [self._condition(case) for method in self._cases[test] for case in handle.method_subtasks(method)]
            texts = (" ".join(case) if len(case) == 1 else f"(and {' '.join(case)})" for case in cases)
            return (f"(or {' '.join(texts)})",)
        wanted = sorted(f"({' '.join(self._fact(fact))})" for fact in handle.preconditions(test))
        unwanted = sorted(f"(not ({' '.join(self._fact(fact))}))" for fact in handle.negative_preconditions(test))
        return (*wanted, *unwanted)

    @cached_property
    def _cases(self) -> dict[int, list[int]]:
        """The methods of each compound task that is only in the ground problem."""
        handle, found = self.grounding.handle, dict[int, list[int]]()
        for method in range(handle.method_count):
            if not self._is_of_the_domain(task := handle.method_task(method)):
                found.setdefault(task, []).append(method)
        return found


class PolicyNodes(Sequence[PolicyNode]):
    """The nodes of a policy, each read when it is first asked for.

    Args:
        reader: reads them.
    """

    def __init__(self, reader: PolicyReader) -> None:
        self._reader = reader
        self._known: dict[int, PolicyNode] = {}

    def __len__(self) -> int:
        return len(self._reader.flat)

    @overload
    def __getitem__(self, index: int) -> PolicyNode: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[PolicyNode]: ...
    def __getitem__(self, index: int | slice) -> PolicyNode | Sequence[PolicyNode]:
        if isinstance(index, slice):
            return [self[at] for at in range(*index.indices(len(self)))]
        at = range(len(self))[index]
        if at not in self._known:
            self._known[at] = self._reader.node(at)
        return self._known[at]
