"""What grounding finds out about a problem: that it has no plan, and what can be a part of none."""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from statehtn.core.grounding import PLAIN, Grounding, ground
from statehtn.errors import Place, StateHtnError
from statehtn.explanation.reason import Reason
from statehtn.explanation.reasons import Reasoner
from statehtn.explanation.relaxation import Relaxation, relaxations
from statehtn.hddl.dead_ends import predicates_made_true
from statehtn.hddl.source_map import ANYTHING
from statehtn.inspection.finding import Finding, Level
from statehtn.inspection.subject import Subject, whole_condition
from statehtn.limits import LimitReached, Limits
from statehtn.model import Action, Atom, Method, Problem
from statehtn.model.cost.probabilities import CostWarning
from statehtn.model.cost.sum import parts_of
from statehtn.model.cost.unknown import UnknownCost
from statehtn.model.formula import conjuncts
from statehtn.model.status import Status

SECONDS_FOR_NO_PLAN, SECONDS_FOR_NOTES = 30.0, 3.0
"""For the reasons why there is no plan, and why something is a part of none, which the planner does not ask for."""
CAUSES = frozenset(
    {
        "contradiction",
        "added-and-deleted",
        "no-method",
        "endless-recursion",
        "no-object",
        "never-true",
        "unused-task",
    }
)
"""Codes of findings that can be the reason why there is no plan."""


@dataclass(frozen=True)
class Reached:
    """What grounding has found out.

    Args:
        grounding: the ground problem, each method and action by itself; None where actions have several outcomes.
        levels: the levels of the relaxation; empty where they take too long.
        reason: why there is no plan, where the relaxation tells; None if it does not.
    """

    grounding: Grounding | None
    levels: tuple[Relaxation, ...]
    reason: Reason | None

    @cached_property
    def used(self) -> frozenset[tuple[str, str]]:
        """What may be a part of a plan: "action" or "method", and its name."""
        assert self.grounding is not None
        grounding, handle = self.grounding, self.grounding.handle
        actions = {grounding.encoding.actions[schema] for schema in set(handle.action_schema)}
        parts = {part for method in range(handle.method_count) for part in range(*handle.method_parts(method))}
        methods = (grounding.encoding.schemes[schema].method for schema in {handle.part_schema(part) for part in parts})
        return frozenset(
            [("action", action.name) for action in actions if action]
            + [("method", method.name) for method in methods if method]
        )


def reached(problem: Problem, limits: Limits) -> Reached:
    """Ground a problem, and look for what no plan contains.

    Raises:
        StateHtnError: it cannot be grounded: a cost is none, say.
        LimitReached: a limit was reached.
    """
    grounding = None
    if not problem.domain.has_outcomes:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", CostWarning)  # told as findings
            grounding = ground(problem, limits, replace(PLAIN, mutexes=True))
    has_plan = grounding is not None and grounding.method_count > 0
    until = time.monotonic() + (SECONDS_FOR_NOTES if has_plan else SECONDS_FOR_NO_PLAN)
    own = replace(limits, deadline=until if limits.deadline is None else min(until, limits.deadline))
    try:
        levels = tuple(relaxations(problem, own))
        reason = None if levels[-1].is_solvable else Reasoner(levels, own).root()
    except LimitReached as ending:
        limits.check()
        if ending.status is not Status.TIME_LIMIT:
            raise
        return Reached(grounding, (), None)
    return Reached(grounding, levels, reason)


def check_reachability(subject: Subject, found: Reached, limits: Limits) -> Iterator[Finding]:
    """Yield that there is no plan, with its root, what no plan contains, and numbers that are not given."""
    yield from _never_true(subject)
    yield from _without_objects(subject)
    if found.grounding is not None:
        yield from _missing_values(found.grounding, subject)
    if found.reason is not None:
        yield _no_plan(subject, found.reason)
    elif found.grounding is None:
        return
    elif not found.grounding.method_count:
        message = "there is no plan: conditions that the initial tasks need never hold at the same time"
        place = subject.places.in_section(":htn")
        yield Finding(Level.ERROR, place, message, "'statehtn why' shows how far one gets", "no-plan")
    else:
        yield from _not_in_plans(subject, found, limits)


def with_causes(findings: Iterable[Finding], reason: Reason) -> Iterator[Finding]:
    """Yield findings, those as errors that are the reason why there is no plan."""
    blamed = {(each.kind, each.name) for each in reason.walk()}
    additions = [each for root in reason.walk() for each in root.additions]
    blamed |= {("fact", each.fact[0]) for each in additions if each.fact is not None}
    blamed |= {("type", each.type) for each in additions if each.type is not None}
    for finding in findings:
        is_cause = finding.code in CAUSES and finding.about in blamed
        yield replace(finding, level=Level.ERROR) if is_cause else finding


def ungrounded(error: StateHtnError) -> Finding:
    """Return the finding that a problem cannot be grounded."""
    return Finding(Level.ERROR, error.place or Place("<input>", 1, 1), error.message, "correct it", "costs")


def _no_plan(subject: Subject, reason: Reason) -> Finding:
    root = main_root(subject, reason)
    owner = _owner(reason, root) or root
    message = f"there is no plan: {reason}"
    if root is not reason:
        message += f"; at the root: {root if root is owner else f'{owner.what} needs {root}'}"
    advice = "see 'statehtn why' for the whole reason and for what would help"
    about = (owner.kind, owner.name) if owner.name else None
    return Finding(Level.ERROR, _place_of(subject, root, owner), message, advice, "no-plan", about)


def _owner(reason: Reason, root: Reason) -> Reason | None:
    """Return the last action or method on the way from a reason to a condition that is a root; None for other roots."""
    if root.kind != "condition":
        return None
    for child in reason.children:
        if any(each is root for each in child.walk()):
            return _owner(child, root) or (reason if reason.kind in ("action", "method") else None)
    return None


def main_root(subject: Subject, reason: Reason) -> Reason:
    """Return the root that is most likely the slip: a predicate that is never true goes before a single fact."""
    problem = subject.problem
    assert problem is not None
    roots = list(reason.roots()) or [reason]
    stated = {fact[0] for fact in problem.initial_state}

    def rank(root: Reason) -> int:
        names = [addition.fact[0] for addition in root.additions if addition.fact is not None]
        if "no method contains it" in root.why or "has no method" in root.why:
            return 0
        return 1 if any(addition.type for addition in root.additions) or not stated.issuperset(names) else 2

    return min(roots, key=rank)


def _place_of(subject: Subject, root: Reason, owner: Reason) -> Place:
    """Return where the model asks for what a root is about, in its owner."""
    predicate = next((each.fact[0] for each in root.additions if each.fact is not None), None)
    inside = () if predicate is None else ((predicate, ANYTHING),)
    if owner.kind == "method":
        return subject.places.inside("method", owner.name, *inside)
    if owner.kind in ("action", "task") and owner.name:
        return subject.places.inside("task", owner.name, *inside)
    if predicate is not None:
        return subject.places.in_section(":goal", *inside)
    return subject.places.in_section(":htn")


def _never_true(subject: Subject) -> Iterator[Finding]:
    """Yield the predicates that are needed somewhere, and that neither the initial state nor an action makes true."""
    problem = subject.problem
    assert problem is not None
    true = predicates_made_true(problem)
    told: set[str] = set()
    for kind, schema in subject.schemas:
        for part in conjuncts(whole_condition(schema)):
            if isinstance(part, Atom) and part.predicate not in true and part.predicate not in told:
                told.add(part.predicate)
                place = subject.places.inside(
                    "method" if kind == "method" else "task", schema.name, (part.predicate, *part.arguments)
                )
                message = (
                    f"{kind} '{schema.name}' needs {part}, but neither ':init' nor an action makes any fact of "
                    f"'{part.predicate}' true"
                )
                advice = "state such a fact in ':init', or add it to the effect of an action"
                yield Finding(Level.NOTE, place, message, advice, "never-true", ("fact", part.predicate))


def _without_objects(subject: Subject) -> Iterator[Finding]:
    """Yield the parameters of types that no object is of."""
    problem = subject.problem
    assert problem is not None
    told: set[tuple[str, ...]] = set()
    for kind, schema in subject.schemas:
        for parameter in schema.parameters:
            if parameter.types in told or problem.objects_of(parameter.types):
                continue
            told.add(parameter.types)
            types = " or ".join(f"'{name}'" for name in parameter.types)
            message = f"there is no object of type {types}, which {kind} '{schema.name}' needs for '{parameter.name}'"
            place = subject.places.inside(
                "method" if kind == "method" else "task", schema.name, (":parameters",), (parameter.name,)
            )
            advice = "add one to ':objects', or correct the type"
            yield Finding(Level.NOTE, place, message, advice, "no-object", ("type", parameter.types[0]))


def _missing_values(grounding: Grounding, subject: Subject) -> Iterator[Finding]:
    """Yield the values that costs of actions need which can be executed, the first of each function."""
    told: set[str] = set()
    for law in (*grounding.laws, *grounding.part_laws):
        for part in parts_of((law,)):
            if isinstance(part, UnknownCost):
                error = part.error
                name = next((name for name in subject.domain.functions if f"({name}" in error.message), error.message)
                if name not in told:
                    told.add(name)
                    place = error.place or subject.places.in_section(":init")
                    yield Finding(Level.WARNING, place, error.message, "", "no-value", ("function", name))


def _not_in_plans(subject: Subject, found: Reached, limits: Limits) -> Iterator[Finding]:
    """Yield the actions and methods that no plan contains, with the reason where it is known."""
    for kind, schema in subject.schemas:
        if (kind, schema.name) in found.used or not _is_mentioned(subject, schema):
            continue
        never = Reasoner(found.levels[:1], limits).condition(schema) if found.levels else None
        message, code = f"{kind} '{schema.name}' is a part of no plan of this problem", "in-no-plan"
        if never is not None:
            word = "executed" if isinstance(schema, Action) else "used"
            message, code = (
                f"{kind} '{schema.name}' can never be {word}: {_why(subject, never, schema)}",
                "never-applies",
            )
        elif found.levels:
            reason = Reasoner(found.levels, limits).never(schema)
            why = "the initial tasks do not lead to it" if reason is None else _why(subject, reason, schema)
            message += f": {why}"
        place = subject.places.declared("method" if kind == "method" else "task", schema.name)
        yield Finding(Level.NOTE, place, message, "this may be meant", code, (kind, schema.name))


def _why(subject: Subject, reason: Reason, schema: Action | Method) -> str:
    """Return the root of a reason in words; without the name of the action or method that it is the reason of."""
    root = main_root(subject, reason)
    return root.why if root is reason and root.name == schema.name else str(root)


def _is_mentioned(subject: Subject, schema: Action | Method) -> bool:
    """Tell whether a network mentions an action, or a method's task; it is told elsewhere if not."""
    name = schema.task if isinstance(schema, Method) else schema.name
    return bool(subject.methods_with[name]) or name in subject.initial_tasks
