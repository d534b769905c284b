"""From what the relaxation lacks to reasons: for a task its methods, for a method its conditions and subtasks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice, product

from statehtn.explanation.lookup import Lookup
from statehtn.explanation.pattern import Pattern, pattern, unified
from statehtn.explanation.query import Domains, Part, Query, parts_of
from statehtn.explanation.reason import SEEN, VALUES, Addition, Reason
from statehtn.explanation.reason_words import NO_REASON, folded, none_of, text_of, values_of
from statehtn.explanation.relaxation import Relaxation
from statehtn.limits import Limits
from statehtn.model import TRUE, Action, And, Atom, Effect, Forall, Formula, Method, Not, Or, Parameter, Subtask

MOST_ADDITIONS = 8
"""Additions that one reason names."""
DEEPEST = 60
"""Reasons below each other; nobody reads further."""
MOST_REASONS = 300
MOST_OBJECTS = 200
"""Combinations of objects for which a condition on all of them is looked at."""


class Reasoner:
    """Finds reasons on the levels of a relaxation that cannot be solved.

    A thing that cannot be done is explained on the first level on which it cannot: there its actions could be asked
    for, so that it lacks a fact or a subtask, or nothing asks for it.
    """

    def __init__(self, levels: Sequence[Relaxation], limits: Limits = Limits()) -> None:
        self.levels = levels
        self.limits = limits
        self.problem = levels[0].problem
        self._lookup = Lookup(self.problem)
        self._told: set[tuple[object, ...]] = set()
        self._open: list[tuple[object, ...]] = []

    def root(self) -> Reason:
        """Return why the initial network cannot be accomplished, or the goal not be reached."""
        problem = self.problem
        condition = And((problem.network.constraints, problem.goal))
        children = self._needs(
            problem.parameters, self._domains(problem.parameters), condition, problem.network.subtasks
        )
        if len(children) == 1:
            return children[0]
        return Reason("the initial network", "cannot be accomplished", children, kind="task")

    def never(self, schema: Action | Method) -> Reason | None:
        """Return why an action or a method can be used with no objects at all; None if nothing but its tasks do."""
        if isinstance(schema, Action):
            return self.condition(schema)
        reason = self.method(schema, self._own(schema))
        return None if reason.why == NO_REASON else reason

    def condition(self, schema: Action | Method) -> Reason | None:
        """Return why the conditions of an action or a method never hold, whatever its subtasks; None if they do."""
        whole = schema.precondition
        if isinstance(schema, Method):
            whole = And((whole, schema.network.constraints))
        own = self._own(schema)
        children = self._needs(schema.parameters, own, whole, ())
        if isinstance(schema, Method):
            return folded(f"method '{schema.name}'", children, "method", schema.name) if children else None
        wanted = pattern(schema.name, [parameter.name for parameter in schema.parameters], own)
        return folded(str(wanted), children, "action", schema.name) if children else None

    def task(self, wanted: Pattern) -> Reason:
        """Return why a task cannot be accomplished, or an action not be executed."""
        action = self.problem.domain.actions.get(wanted.name)
        if action is not None:
            terms = tuple(parameter.name for parameter in action.parameters)
            domains = unified(terms, wanted, self._domains(action.parameters))
            if domains is None:
                return Reason(str(wanted), "its arguments are of other types", kind="action", name=wanted.name)
            return self.action(action, domains)
        if (before := self._told_before("task", wanted)) is not None:
            return before
        methods = self._lookup.methods_of[wanted.name]
        with_these = [(method, unified(method.arguments, wanted, self._own(method))) for method in methods]
        self._open.append(("task", wanted.key))
        children = tuple(self.method(method, domains) for method, domains in with_these if domains is not None)
        self._open.pop()
        why = "it has no method"
        if methods and not children:
            why = none_of(len(methods), "its only method is not", "none of its {} methods is", "for these arguments")
        elif methods:
            why = none_of(len(children), "its only method cannot", "none of its {} methods can", "be used")
        return Reason(str(wanted), why, children, kind="task", name=wanted.name)

    def method(self, method: Method, domains: Domains) -> Reason:
        """Return why a method cannot be used with variables that stand for such objects."""
        condition = And((method.precondition, method.network.constraints))
        children = self._needs(method.parameters, domains, condition, method.network.subtasks)
        return folded(f"method '{method.name}'", children, "method", method.name)

    def action(self, action: Action, domains: Domains, condition: Formula = TRUE) -> Reason:
        """Return why an action cannot be executed with variables that stand for such objects.

        Args:
            condition: what else is to hold, for an effect, say.
        """
        wanted = pattern(action.name, [parameter.name for parameter in action.parameters], domains)
        if (before := self._told_before("action", wanted, condition)) is not None:
            return before
        self._open.append(("action", wanted.key))
        parameters = [*action.parameters, *(Parameter(name) for name in domains if name not in self._own(action))]
        children = self._needs(parameters, domains, And((action.precondition, condition)), ())
        if not children:
            reason = self._not_asked_for(action, wanted)
            self._open.pop()
            return reason
        self._open.pop()
        return folded(str(wanted), children, "action", action.name)

    def fact(self, wanted: Pattern) -> Reason:
        """Return why a fact cannot be made true."""
        additions = tuple(Addition((wanted.name, *row)) for row in wanted.rows(MOST_ADDITIONS))
        if (before := self._told_before("fact", wanted)) is not None:
            return Reason(before.what, before.why, (), additions, "fact", wanted.name)
        achievers: list[tuple[Action, Domains, Effect]] = []
        for action, effect in self._lookup.achievers[wanted.name]:
            own = self._domains((*action.parameters, *effect.parameters))
            domains = unified(effect.atom.arguments, wanted, own)
            if domains is not None and all(action is not other for other, _, _ in achievers):
                achievers.append((action, domains, effect))
        if not achievers:
            why = "neither ':init' nor an action makes it true"
            return Reason(str(wanted), why, (), additions, "fact", wanted.name)
        self._open.append(("fact", wanted.key))
        children = tuple(self.action(action, domains, effect.condition) for action, domains, effect in achievers)
        self._open.pop()
        only, none = "the only action that makes it true cannot", "none of the {} actions that make it true can"
        why = f"':init' does not state it, and {none_of(len(children), only, none, 'be executed')}"
        return Reason(str(wanted), why, children, additions, "fact", wanted.name)

    def _needs(
        self, parameters: Sequence[Parameter], domains: Domains, condition: Formula, subtasks: Sequence[Subtask]
    ) -> tuple[Reason, ...]:
        """Return why no binding gives a condition and subtasks; nothing if some binding does on every level."""
        if len(self._told) > MOST_REASONS or len(self._open) > DEEPEST:
            return (Reason("more", "it goes on like this, and is left out here"),)
        types = {parameter.name: parameter.types for parameter in parameters}
        parts = [part for part in parts_of(condition, types) if part.formula != TRUE]
        parts += [Part(task=subtask) for subtask in subtasks]
        whole = {**{name: self.problem.objects_of(kinds) for name, kinds in types.items()}, **domains}
        for name, kinds in types.items():  # those of 'exists', too
            if not whole[name]:
                words = " or ".join(f"'{kind}'" for kind in kinds)
                additions = tuple(Addition(type=kind) for kind in kinds)
                return (Reason(f"an object of type {words} for {name}", "there is none", (), additions),)
        for level in self.levels:
            query = Query(whole, tuple(parts), level, self.limits)
            if not query.has_answer():
                return tuple(reason for core in query.cores() for reason in self._of_core(query, core))
        return ()

    def _of_core(self, query: Query, core: tuple[Part, ...]) -> Iterator[Reason]:
        """Yield why parts have no answer together."""
        if len(core) == 1:
            yield self._of_part(core[0], query.domains)
            return
        texts = [text_of(part, query.domains) for part in core]
        shared = sorted({name for part in core for name in part.variables if len(query.domains[name]) > 1})
        objects = f"no {', '.join(shared)}" if shared else "nothing"
        children: list[Reason] = []
        additions: list[Addition] = []
        for part, text in zip(core, texts, strict=True):
            if not part.is_relational:
                continue
            others = [other for other in core if other is not part]
            bindings = list(islice(query.answers(others), MOST_ADDITIONS))
            narrowed = [
                {**query.domains, **{name: (value,) for name, value in binding.items()}} for binding in bindings
            ]
            # Where a condition and its negation exclude each other, either can be had with what the other one takes.
            narrowed = [each for each in narrowed if not replace(query, domains=each).has_answer([part])]
            if not narrowed:
                continue
            if part.formula is not None:
                assert isinstance(part.formula, Atom)
                rows = (pattern(part.formula.predicate, part.terms, domains) for domains in narrowed)
                additions += [Addition((row.name, *next(row.rows(1)))) for row in rows]
            children.append(Reason(text, f"can be had only with {values_of(query, part)}", kind=VALUES))
            child = self._of_part(part, narrowed[0])
            if child.children:
                children.append(child)
        why = f"{objects} goes together with all of these"
        yield Reason(" and ".join(texts), why, tuple(children), tuple(dict.fromkeys(additions))[:MOST_ADDITIONS])

    def _of_part(self, part: Part, domains: Domains) -> Reason:
        if part.task is not None:
            return self.task(pattern(part.task.task, part.terms, domains))
        match part.formula:
            case Atom(predicate, terms):
                return self.fact(pattern(predicate, terms, domains))
            case Not(Atom()):
                return Reason(
                    text_of(part, domains), "':init' states the opposite, and no action that can be executed changes it"
                )
            case Or(operands):
                children = [reason for each in operands for reason in self._needs((), domains, each, ())]
                additions = tuple(dict.fromkeys(each for child in children for each in child.additions))
                return Reason(text_of(part, domains), "none of these can hold", tuple(children), additions)
            case Forall(parameters, body):
                return self._of_all(part, parameters, body, domains)
        return Reason(text_of(part, domains), "it can never hold here")

    def _of_all(self, part: Part, parameters: Sequence[Parameter], body: Formula, domains: Domains) -> Reason:
        """Return why something does not hold for all objects: those for which it does not, the first that are found."""
        for row in islice(product(*self._domains(parameters).values()), MOST_OBJECTS):
            names = [parameter.name for parameter in parameters]
            bound = {**domains, **{name: (value,) for name, value in zip(names, row, strict=True)}}
            if children := self._needs((), bound, body, ()):
                given = ", ".join(f"{name} = {value}" for name, value in zip(names, row, strict=True))
                return Reason(text_of(part, domains), f"it can never hold for {given}", children)
        return Reason(text_of(part, domains), "it can never hold here")

    def _not_asked_for(self, action: Action, wanted: Pattern) -> Reason:
        """Return why no task leads to an action that could be executed."""
        users = [
            (method, subtask)
            for method in self.problem.domain.methods.values()
            for subtask in method.network.subtasks
            if subtask.task == action.name
        ]
        told = str(wanted)
        if not users:
            return Reason(told, "it could be executed, but no method contains it", kind="action", name=action.name)
        users = [(method, subtask) for method, subtask in users if method.task in self._lookup.reachable]
        if not users:
            return Reason(
                told,
                "it could be executed, but no task of the initial network leads to it",
                kind="action",
                name=action.name,
            )
        children = []
        for method, subtask in users:
            domains = unified(subtask.arguments, wanted, self._own(method))
            if domains is not None:
                reason = self.method(method, domains)
                if reason.children or reason.why != NO_REASON:
                    children.append(reason)
        if not children:
            return Reason(
                told,
                "it could be executed, but the initial network leads to it with other arguments only",
                kind="action",
                name=action.name,
            )
        return Reason(told, "it could be executed, but only methods that cannot be used lead to it", tuple(children))

    def _told_before(self, kind: str, wanted: Pattern, condition: Formula = TRUE) -> Reason | None:
        """Return a short reason for what stands elsewhere in the tree already."""
        if (kind, wanted.key) in self._open:
            return Reason(str(wanted), "it would have to come before itself", kind=kind, name=wanted.name)
        key = (kind, wanted.key, condition)
        if key in self._told:
            return Reason(str(wanted), SEEN, kind=kind, name=wanted.name)
        self._told.add(key)
        return None

    def _domains(self, parameters: Sequence[Parameter]) -> Domains:
        return {parameter.name: self.problem.objects_of(parameter.types) for parameter in parameters}

    def _own(self, schema: Action | Method) -> Domains:
        return self._domains(schema.parameters)
