"""What no plan can get past, and is likely a slip: tasks without methods, and facts that nothing makes true.

A task without a method is told wherever it stands in a network. A needed fact is told only where the problem has no
plan for want of it: many domains have predicates that a small problem makes no use of. So it is a part of the goal, or
a precondition in what every decomposition of the initial network contains.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Container, Iterator
from dataclasses import dataclass

from statehtn.hddl.diagnostics import Diagnostics
from statehtn.hddl.expressions import Group, Node, Word, parse_group
from statehtn.hddl.tokens import Source
from statehtn.hddl.vocabulary import Kind, Vocabulary
from statehtn.model import Action, And, Atom, Domain, Effect, Exists, Fact, Formula, Method, Problem
from statehtn.model.formula import is_variable

Owner = tuple[Kind, str]
"""A method, or an action (of the kind `task`), by its name."""


@dataclass(frozen=True, slots=True)
class DeadEnd:
    """What no plan can get past.

    Args:
        message: a sentence about it.
        kind: of the thing that it is about: a method, or a task or action (`task`).
        name: of that thing.
        fact: the fact of the goal that it is about, instead.
        is_proof: the problem has no plan.
    """

    message: str
    kind: Kind = "task"
    name: str = ""
    fact: Fact | None = None
    is_proof: bool = True


def warn_of_dead_ends(problem: Problem, vocabulary: Vocabulary, source: Source, diagnostics: Diagnostics) -> None:
    """Note a warning for every task without a method, and for every fact that is needed and can never be true.

    Args:
        problem: as it was read.
        vocabulary: knows where things are declared.
        source: the problem's file.

    Raises:
        InputError: there is one, in strict mode.
    """
    for found in dead_ends(problem):
        at = (source, _token_in_goal(found.fact, source)) if found.fact else vocabulary.token(found.kind, found.name)
        diagnostics.warn(found.message, *at)


def dead_ends(problem: Problem) -> Iterator[DeadEnd]:
    """Yield the tasks without a method that stand in a network, and the needed facts that can never be true."""
    for task, user in _without_methods(problem):
        message = f"task '{task}' has no method, so that {user}, where it stands, leads to no plan"
        yield DeadEnd(message, "task", task, is_proof=False)
    for (kind, name), atom in _needed_in_vain(problem):
        what = f"{'method' if kind == 'method' else 'action'} '{name}' needs {atom}"
        nothing = f"neither ':init' nor an action makes any fact of '{atom.predicate}' true"
        yield DeadEnd(f"{what}, but {nothing}: there is no plan", kind, name)
    for fact in _goals_in_vain(problem):
        message = f"neither ':init' nor an action makes ({' '.join(fact)}) true: there is no plan"
        yield DeadEnd(message, fact=fact)


def _without_methods(problem: Problem) -> Iterator[tuple[str, str]]:
    """Yield the tasks that stand in a network and have no method, with the first that they stand in."""
    users = {subtask.task: "the initial network" for subtask in problem.network.subtasks}
    for method in problem.domain.methods.values():
        for subtask in method.network.subtasks:
            users.setdefault(subtask.task, f"method '{method.name}'")
    decomposed = {method.task for method in problem.domain.methods.values()}
    yield from ((task, users[task]) for task in problem.domain.tasks if task in users and task not in decomposed)


def predicates_made_true(problem: Problem) -> set[str]:
    """Return the predicates of which the initial state has a fact, or an action makes one true."""
    true = {fact[0] for fact in problem.initial_state}
    effects = (effect for action in problem.domain.actions.values() for effect in action.all_effects)
    true.update(effect.atom.predicate for effect in effects if effect.positive)
    return true


def _needed_in_vain(problem: Problem) -> Iterator[tuple[Owner, Atom]]:
    """Yield the preconditions that never hold and that the initial network cannot do without."""
    domain = problem.domain
    true = predicates_made_true(problem)
    lacking: dict[Owner, Atom] = {}
    owners: list[tuple[Kind, Action | Method]] = [("task", action) for action in domain.actions.values()]
    owners += [("method", method) for method in domain.methods.values()]
    for kind, owner in owners:
        for atom in _conjuncts(owner.precondition):
            if atom.predicate not in true:
                lacking.setdefault((kind, owner.name), atom)
    if lacking:
        needed = _needed(problem, _impossible_tasks(domain, lacking))
        yield from ((owner, atom) for owner, atom in lacking.items() if owner in needed)


def _impossible_tasks(domain: Domain, lacking: Container[Owner]) -> set[str]:
    """Return the tasks all of whose decompositions contain an action or a method that lacks something.

    It is the least set: a task that only leads back to itself is not told here.
    """
    containing: defaultdict[str, list[Method]] = defaultdict(list)
    for method in domain.methods.values():
        for task in {subtask.task for subtask in method.network.subtasks}:
            containing[task].append(method)
    ways = Counter(method.task for method in domain.methods.values())
    closed: set[str] = set()
    found: set[str] = set()
    pending = [name for name in domain.actions if ("task", name) in lacking]

    def close(method: Method) -> None:
        if method.name not in closed:
            closed.add(method.name)
            ways[method.task] -= 1
            if not ways[method.task]:
                pending.append(method.task)

    for method in domain.methods.values():
        if ("method", method.name) in lacking:
            close(method)
    while pending:
        task = pending.pop()
        found.add(task)
        for method in containing[task]:
            close(method)
    return found


def _needed(problem: Problem, impossible: set[str]) -> set[Owner]:
    """Return the actions and methods by which the impossible tasks of the initial network could be accomplished."""
    methods: defaultdict[str, list[Method]] = defaultdict(list)
    for method in problem.domain.methods.values():
        methods[method.task].append(method)
    found: set[Owner] = set()
    pending = [subtask.task for subtask in problem.network.subtasks]
    while pending:
        task = pending.pop()
        if task in impossible and ("task", task) not in found:
            found.add(("task", task))
            for method in methods[task]:
                found.add(("method", method.name))
                pending += [subtask.task for subtask in method.network.subtasks]
    return found


def _goals_in_vain(problem: Problem) -> Iterator[Fact]:
    """Yield the facts of the goal that are not true at first and no effect can make true."""
    for atom in _conjuncts(problem.goal):
        fact = (atom.predicate, *atom.arguments)
        if fact in problem.initial_state or any(map(is_variable, atom.arguments)):
            continue
        if not any(
            effect.positive and _can_be(effect, action, atom, problem)
            for action in problem.domain.actions.values()
            for effect in action.all_effects
        ):
            yield fact


def _can_be(effect: Effect, action: Action, atom: Atom, problem: Problem) -> bool:
    """Tell whether an effect can be about a ground atom."""
    if effect.atom.predicate != atom.predicate:
        return False
    types = {parameter.name: parameter.types for parameter in (*action.parameters, *effect.parameters)}
    bindings: dict[str, str] = {}
    for term, name in zip(effect.atom.arguments, atom.arguments, strict=True):
        if bindings.setdefault(term, name if is_variable(term) else term) != name:
            return False
        if is_variable(term) and not problem.domain.types.is_subtype(problem.all_objects[name], types[term]):
            return False
    return True


def _conjuncts(formula: Formula) -> Iterator[Atom]:
    """Yield atoms that must each hold, for some objects at least, for the formula to hold."""
    match formula:
        case Atom():
            yield formula
        case And(operands):
            for operand in operands:
                yield from _conjuncts(operand)
        case Exists(_, body):
            yield from _conjuncts(body)


def _token_in_goal(fact: Fact, source: Source) -> int:
    """Return the token at which the goal states a fact."""
    start = next(start for start, _ in source.sections if source.tokens[start + 1].lower() == ":goal")
    pending: list[Node] = [parse_group(source, start)]
    while pending:
        node = pending.pop()
        if isinstance(node, Group):
            words = tuple(item.lower for item in node.items if isinstance(item, Word))
            if words == tuple(map(str.lower, fact)):
                return node.index
            pending += reversed(node.items)
    return start
