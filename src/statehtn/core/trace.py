"""From the core's decomposition tree to a plan of the lifted problem: what was compiled in is taken out again.

A long plan repeats few ground actions and methods: what is the same wherever one of them stands is worked out once.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from itertools import islice
from operator import itemgetter
from typing import cast

import statehtn._relax as _relax
from statehtn.collector import without_collector
from statehtn.core.grounding import Grounding
from statehtn.core.outcome_trace import outcomes_of
from statehtn.core.schemes import Scheme
from statehtn.limits import Limits
from statehtn.model import CostLaw, Decomposition, Plan, Step
from statehtn.model.cost.scenario_cost import sum_of


@dataclass(slots=True)
class _Part:
    """What a part of a method contributes to it: objects of its variables, and subtasks with their positions there."""

    bindings: dict[str, str]
    children: list[tuple[int, int | Decomposition]]


UNITS = 1024  # of work between two looks at the limits: some hundredths of a second

Child = int | Decomposition | _Part
Placed = list[tuple[int, int | Decomposition]]
"""What has become of subtasks, each with its position in the lifted network."""


class _Scheme:
    """A scheme in a ground method, with objects for its variables.

    Args:
        scheme: the scheme.
        bindings: the objects.
        parent: which of the ground method's schemes it decomposes a subtask of; 0 for the first.
        position: where that subtask stands in the lifted method; None where it stands for a part of it.
    """

    def __init__(self, scheme: Scheme, bindings: dict[str, str], parent: int, position: int | None) -> None:
        self.scheme = scheme
        self.bindings = bindings
        self.parent = parent
        self.position = position
        self._method = scheme.method
        self._names = [parameter.name for parameter in scheme.method.parameters] if scheme.method else []
        # Where no part of the method is elsewhere, everything is known but the children.
        self._objects = self._look_up(bindings) if bindings.keys() >= set(self._names) else None
        self._arguments = tuple(bindings.get(term, term) for term in scheme.arguments)

    def finished(self, bindings: dict[str, str], children: Placed) -> Child:
        """Return the decomposition by the whole method, once everything is there; a part of it for a part."""
        if self.scheme.is_part:
            return _Part(bindings, children)
        method = self._method
        assert method is not None
        objects = self._look_up(bindings) if self._objects is None else self._objects
        return Decomposition(method.task, self._arguments, method.name, in_order(children), objects)

    def _look_up(self, bindings: dict[str, str]) -> tuple[str, ...]:
        return tuple([bindings[name] for name in self._names])


class _GroundMethod:
    """A ground method of the core: the schemes that it applies at once.

    Args:
        grounding: the ground problem.
        method: the core's number.
        parts: the tasks that parts of methods decompose.
    """

    def __init__(self, grounding: Grounding, method: int, parts: set[str]) -> None:
        handle, schemes = grounding.handle, grounding.encoding.schemes
        self.schemes: list[_Scheme] = []
        for number, part in enumerate(range(*handle.method_parts(method))):
            scheme = schemes[handle.part_schema(part)]
            names = (parameter.name for parameter in scheme.parameters)
            bindings = dict(zip(names, grounding.objects(handle.part_arguments(part)), strict=True))
            parent, index = handle.part_origin(part) if number else (0, 0)
            position = self.schemes[parent].scheme.subtasks[index].position if number else None
            self.schemes.append(_Scheme(scheme, bindings, parent, position))
        # By subtask of the ground method: which scheme it belongs to, and its position in the lifted method. A choice
        # between the cases of an action has no schemes.
        self._places = [
            (scheme, self.schemes[scheme].scheme.subtasks[index].position)
            for scheme, index in (handle.method_positions(method) if self.schemes else ())
        ]
        self._is_whole = len(self.schemes) == 1 and parts.isdisjoint(
            subtask.task for subtask in self.schemes[0].scheme.subtasks
        )

    def apply(self, below: list[tuple[int, Child]]) -> tuple[dict[str, str], Placed]:
        """Return what the schemes and what has become of their subtasks make together: bindings, and children."""
        schemes, places = self.schemes, self._places
        bindings = [scheme.bindings for scheme in schemes]
        children: list[Placed] = [[] for _ in schemes]
        waiting = [(*places[subtask], child) for subtask, child in below]
        # Schemes come after the schemes whose subtasks they decompose.
        for number in range(len(schemes), 0, -1):
            if number < len(schemes):
                scheme = schemes[number]
                waiting = [(scheme.parent, scheme.position, scheme.finished(bindings[number], children[number]))]
            for at, position, child in waiting:
                if isinstance(child, _Part):
                    bindings[at] = bindings[at] | child.bindings
                    children[at] += child.children
                else:
                    assert position is not None
                    children[at].append((position, child))
        return bindings[0], children[0]

    def finished(self, below: list[tuple[int, Child]]) -> Child:
        """Return the decomposition by the lifted method, or a part of it."""
        first = self.schemes[0]
        if self._is_whole:  # the usual case
            children = [(self._places[subtask][1], child) for subtask, child in below]
            return first.finished(first.bindings, cast("Placed", children))
        return first.finished(*self.apply(below))


class TraceReader:
    """Reads plans from results of searches in one ground problem.

    Args:
        grounding: the ground problem.
    """

    def __init__(self, grounding: Grounding) -> None:
        self._grounding = grounding
        self._schemas = grounding.handle.action_schema
        self._parts = {scheme.task for scheme in grounding.encoding.schemes if scheme.is_part}
        self._steps: dict[int, Step | None] = {}  # by ground action; None for precondition actions
        self._laws: dict[tuple[int, ...], CostLaw] = {}
        self._methods: dict[int, _GroundMethod] = {}

    def read(self, result: _relax.SearchResult, limits: Limits = Limits()) -> Plan:
        """Return the plan of a search result, with the costs that the search has seen; the result must have one.

        Precondition actions vanish, a choice between cases of an action becomes the action, and methods that were split
        or applied at once stand as in the domain.

        Raises:
            LimitReached: a limit was reached before that.
        """
        due = iter(result.due_parts)
        steps: list[Step] = []
        costs: list[CostLaw] = []
        step_of: dict[int, int] = {}  # by tree node
        for leaf, (number, count) in enumerate(zip(result.plan, result.due_part_counts, strict=True)):
            if leaf % UNITS == 0:
                limits.check()
            action = result.node(number).task
            step = self._step(action)
            if step is not None:
                step_of[number] = len(steps)
                steps.append(step)
                costs.append(self._law(action, tuple(islice(due, count))))
        with without_collector():
            bindings, children = self._decomposition(result, step_of, limits)
        root = tuple(bindings[parameter.name] for parameter in self._grounding.problem.parameters)
        plan = Plan(tuple(steps), in_order(children), root, tuple(costs))
        if not self._grounding.problem.domain.has_outcomes:
            return plan
        outcomes = outcomes_of(self._grounding, [result.node(number).task for number in result.plan])
        return replace(plan, outcomes=outcomes, seen=self._grounding.seen_facts())

    def _decomposition(
        self, result: _relax.SearchResult, step_of: dict[int, int], limits: Limits
    ) -> tuple[dict[str, str], Placed]:
        """Return what the initial network's variables are bound to, and what becomes of its tasks."""
        below: defaultdict[int, list[tuple[int, Child]]] = defaultdict(list)  # by tree node, with subtasks' indexes
        work = 0
        # Children come after their parents, so that going backwards every node's children are complete.
        for number in range(result.node_count - 1, 0, -1):
            node = result.node(number)
            parent = node.parent
            assert parent is not None
            siblings = below[parent]
            if node.method is None:
                if number in step_of:
                    siblings.append((node.subtask, step_of[number]))
                continue
            method = self._method(node.method)
            children = below.pop(number, [])
            work += 1 + len(method.schemes)
            if work >= UNITS:
                limits.check()
                work = 0
            if method.schemes:
                siblings.append((node.subtask, method.finished(children)))
            else:  # a choice; nothing is left of it where the chosen case is a precondition action
                siblings += ((node.subtask, child) for _, child in children)
        initial = result.node(0).method
        assert initial is not None
        return self._method(initial).apply(below[0])

    def _step(self, action: int) -> Step | None:
        """Return a ground action as it stands in plans; None for a precondition action."""
        if action not in self._steps:
            lifted = self._grounding.encoding.actions[self._schemas[action]]
            objects = self._grounding.objects(self._grounding.handle.action_arguments(action))
            self._steps[action] = None if lifted is None else Step(lifted.name, objects)
        return self._steps[action]

    def _law(self, action: int, due: tuple[int, ...]) -> CostLaw:
        """Return the law of an action's cost where these parts of it are due."""
        base = self._grounding.laws[action]
        if not due:
            return base
        law = self._laws.get(due)  # a part belongs to one action
        if law is None:
            law = self._laws[due] = sum_of([base, *(self._grounding.part_laws[part] for part in due)])
        return law

    def _method(self, method: int) -> _GroundMethod:
        found = self._methods.get(method)
        if found is None:
            found = self._methods[method] = _GroundMethod(self._grounding, method, self._parts)
        return found


def in_order(children: Placed) -> tuple[int | Decomposition, ...]:
    """Return the children in the order of the lifted network."""
    if len(children) > 1:
        children.sort(key=itemgetter(0))
    return tuple([child for _, child in children])
