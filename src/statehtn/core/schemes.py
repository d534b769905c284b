"""Methods as the grounder takes them: only what can change is left in preconditions, and unrelated choices are parted.

Each step keeps the set of decompositions. What stands in a precondition but can never change becomes a constraint. What
can change becomes a task of its own before all subtasks (an action without effects). A subtask whose other variables
nothing else mentions is handed over to a new task, so that the instances of a method are not the product of choices
that have nothing to do with each other, as pandaPIparser does before it grounds.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from statehtn.model import TRUE, And, Exists, Formula, Method, Parameter, Problem, TaskNetwork
from statehtn.model.formula import conjuncts, free_variables, predicates

Ordering = tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class PreconditionAction:
    """An action without effects that stands for a method's precondition or for the goal."""

    name: str
    parameters: tuple[Parameter, ...]
    condition: Formula


@dataclass(frozen=True)
class SchemeSubtask:
    """A subtask; `position` is its index in the lifted network, None for what the lifted network does not have."""

    task: str
    arguments: tuple[str, ...]
    position: int | None


@dataclass(frozen=True)
class Scheme:
    """A method as the grounder takes it.

    Args:
        method: what it comes from; None for the initial network.
        task: the compound task that it decomposes; names that are not the domain's have a space in them.
        parameters: those that are left here; a part has the rest.
        constraints: whatever can never change.
        is_part: whether this scheme is a part of another one of the same method, with parameters of the same names.
    """

    method: Method | None
    task: str
    arguments: tuple[str, ...]
    parameters: tuple[Parameter, ...]
    constraints: Formula
    subtasks: tuple[SchemeSubtask, ...]
    ordering: Ordering
    is_part: bool = False


INITIAL_TASK = "initial network"


def method_schemes(problem: Problem, split: bool) -> tuple[list[PreconditionAction], list[Scheme]]:
    """Return the precondition actions and the methods of a problem; the last scheme that is no part is the network.

    Args:
        problem: the lifted problem.
        split: whether to part unrelated choices.
    """
    fluents = {effect.atom.predicate for action in problem.domain.actions.values() for effect in action.all_effects}
    precondition_actions: list[PreconditionAction] = []
    schemes: list[Scheme] = []
    for method in problem.domain.methods.values():
        static, changing = _partition(conjuncts(method.precondition), fluents)
        subtasks = _own_subtasks(method.network)
        ordering = method.network.ordering
        if changing:
            fixed = (*static, *conjuncts(method.network.constraints))
            action = _precondition_action(f"precondition of {method.name}", method.parameters, changing, fixed)
            precondition_actions.append(action)
            first = SchemeSubtask(action.name, tuple(p.name for p in action.parameters), None)
            subtasks = (first, *subtasks)
            ordering = (
                *((earlier + 1, later + 1) for earlier, later in ordering),
                *((0, position) for position in range(1, len(subtasks))),
            )
        constraints = And((*conjuncts(method.network.constraints), *static))
        schemes.append(
            Scheme(method, method.task, method.arguments, method.parameters, constraints, subtasks, ordering)
        )
    schemes.append(_initial_scheme(problem, precondition_actions))
    return precondition_actions, [part for scheme in schemes for part in (_split(scheme) if split else [scheme])]


def _initial_scheme(problem: Problem, precondition_actions: list[PreconditionAction]) -> Scheme:
    subtasks = _own_subtasks(problem.network)
    ordering = problem.network.ordering
    if problem.goal != TRUE:
        precondition_actions.append(PreconditionAction("goal", (), problem.goal))
        ordering = (*ordering, *((position, len(subtasks)) for position in range(len(subtasks))))
        subtasks = (*subtasks, SchemeSubtask("goal", (), None))
    return Scheme(None, INITIAL_TASK, (), problem.parameters, problem.network.constraints, subtasks, ordering)


def _own_subtasks(network: TaskNetwork) -> tuple[SchemeSubtask, ...]:
    return tuple(
        SchemeSubtask(subtask.task, subtask.arguments, position) for position, subtask in enumerate(network.subtasks)
    )


def _partition(formulas: Iterable[Formula], fluents: set[str]) -> tuple[list[Formula], list[Formula]]:
    """Part formulas into those that can never change and the others."""
    static: list[Formula] = []
    changing: list[Formula] = []
    for formula in formulas:
        (static if fluents.isdisjoint(predicates(formula)) else changing).append(formula)
    return static, changing


def _precondition_action(
    name: str, parameters: Sequence[Parameter], condition: Sequence[Formula], fixed: Sequence[Formula]
) -> PreconditionAction:
    """Return an action with this precondition, and with whatever else is known of its variables.

    What is fixed the method demands in any case. Without it the action would have an instance for every combination of
    objects for which its facts can be true one by one.
    """
    names = set(free_variables(And(tuple(condition))))
    whole = (*condition, *_projections(fixed, names, parameters))
    own = tuple(parameter for parameter in parameters if parameter.name in names)
    return PreconditionAction(name, own, whole[0] if len(whole) == 1 else And(whole))


_MOST_OTHERS = 2  # variables that a projection looks for; each is a join


def _projections(fixed: Sequence[Formula], names: set[str], parameters: Sequence[Parameter]) -> Iterator[Formula]:
    """Yield what formulas say of these variables: formulas tied by others stand together, below `exists`."""
    rest = [(formula, set(free_variables(formula))) for formula in fixed]
    while rest:
        formula, mentioned = rest.pop(0)
        together = [formula]
        while tied := next((pair for pair in rest if pair[1] & mentioned - names), None):
            rest.remove(tied)
            together.append(tied[0])
            mentioned |= tied[1]
        others = tuple(parameter for parameter in parameters if parameter.name in mentioned - names)
        if mentioned & names and len(others) <= _MOST_OTHERS:
            whole = together[0] if len(together) == 1 else And(tuple(together))
            yield Exists(others, whole) if others else whole


def _split(scheme: Scheme) -> list[Scheme]:
    """Hand subtasks with variables of their own over to new tasks, as long as other variables are left beside them."""
    parts: list[Scheme] = []
    while cut := next((cut for cut in _cuts(scheme) if cut.others), None):
        part, scheme = _cut(scheme, cut, len(parts) + 1)
        parts += _split(part)
    return [*parts, scheme]


@dataclass(frozen=True)
class _Cut:
    """Subtasks that could go to a new task.

    Args:
        indices: which ones; all other subtasks are ordered in the same way to each of them.
        own: variables that nothing else mentions; they go along.
        moved: the constraints with such variables.
        shared: the other variables that the subtasks and these constraints mention.
        others: the remaining variables of the scheme.
    """

    indices: tuple[int, ...]
    own: frozenset[str]
    moved: tuple[Formula, ...]
    shared: frozenset[str]
    others: frozenset[str]


def _cuts(scheme: Scheme) -> Iterator[_Cut]:
    """Yield the cuts, those of few subtasks first, and late subtasks before early ones."""
    free = {parameter.name for parameter in scheme.parameters} - set(scheme.arguments)
    users: dict[str, set[int]] = {name: set() for name in free}
    for index, subtask in enumerate(scheme.subtasks):
        for name in _variables(subtask) & free:
            users[name].add(index)
    groups = {tuple(sorted(indices)) for indices in users.values() if 0 < len(indices) < len(scheme.subtasks)}
    constraints = [(formula, set(free_variables(formula))) for formula in conjuncts(scheme.constraints)]
    for indices in sorted(groups, key=lambda group: (len(group), [-index for index in group])):
        if not _is_module(scheme, indices):
            continue
        own = {name for name, where in users.items() if where and where.issubset(indices)}
        # Variables of constraints only go along unless they tie others that stay and have one user.
        staying = {name for name, where in users.items() if len(where) == 1} - own
        loose = {name for name, where in users.items() if not where}
        for name in sorted(loose):
            tied = {name}
            while grown := {n for _, names in constraints if names & tied & loose for n in names} - tied:
                tied |= grown
            if tied & own and not tied & staying:
                own.add(name)
        moved = [(formula, names) for formula, names in constraints if names & own]
        mentioned = set().union(*(_variables(scheme.subtasks[index]) for index in indices))
        shared = mentioned.union(*(names for _, names in moved)) - own
        others = {parameter.name for parameter in scheme.parameters} - own - shared
        yield _Cut(
            indices, frozenset(own), tuple(formula for formula, _ in moved), frozenset(shared), frozenset(others)
        )


def _is_module(scheme: Scheme, indices: tuple[int, ...]) -> bool:
    """Tell whether every other subtask is before all of these, after all, or unordered to all."""
    if len(indices) == 1:
        return True
    after = _transitive(scheme)
    inside = set(indices)
    return all(
        len({(index in after[other], other in after[index]) for index in indices}) == 1
        for other in range(len(scheme.subtasks))
        if other not in inside
    )


def _transitive(scheme: Scheme) -> list[set[int]]:
    """Return for every subtask those that come after it."""
    after: list[set[int]] = [set() for _ in scheme.subtasks]
    for first, second in scheme.ordering:
        after[first].add(second)
    for middle, beyond in enumerate(after):
        for successors in after:
            if middle in successors:
                successors |= beyond
    return after


def _cut(scheme: Scheme, cut: _Cut, number: int) -> tuple[Scheme, Scheme]:
    """Return the part that is cut off, and the scheme with a new task in its place."""
    handed = tuple(parameter.name for parameter in scheme.parameters if parameter.name in cut.shared)
    name = f"part {number} of {scheme.method.name if scheme.method and not scheme.is_part else scheme.task}"
    place = {index: at for at, index in enumerate(cut.indices)}  # in the part
    part = Scheme(
        scheme.method,
        name,
        handed,
        tuple(parameter for parameter in scheme.parameters if parameter.name in cut.own | cut.shared),
        And(cut.moved),
        tuple(scheme.subtasks[index] for index in cut.indices),
        tuple((place[first], place[second]) for first, second in scheme.ordering if {first, second} <= place.keys()),
        is_part=True,
    )
    first = cut.indices[0]
    rest = replace(
        scheme,
        parameters=tuple(parameter for parameter in scheme.parameters if parameter.name not in cut.own),
        constraints=And(tuple(formula for formula in conjuncts(scheme.constraints) if formula not in cut.moved)),
        subtasks=tuple(
            SchemeSubtask(name, handed, None) if index == first else subtask
            for index, subtask in enumerate(scheme.subtasks)
            if index == first or index not in place
        ),
        ordering=_ordering_of_the_rest(scheme, cut.indices),
    )
    return part, rest


def _ordering_of_the_rest(scheme: Scheme, indices: tuple[int, ...]) -> Ordering:
    """Return the ordering where one subtask, in the place of the first, stands for all of these."""
    if len(indices) == 1:
        return scheme.ordering
    at: list[int] = []  # by index: the new one
    others = 0  # so far
    for index in range(len(scheme.subtasks)):
        at.append(at[indices[0]] if index in indices[1:] else index - others)
        others += index in indices[1:]
    after = _transitive(scheme)
    pairs = {(at[one], at[two]) for one, beyond in enumerate(after) for two in beyond}
    return tuple(sorted((one, two) for one, two in pairs if one != two))


def _variables(subtask: SchemeSubtask) -> set[str]:
    return {argument for argument in subtask.arguments if argument.startswith("?")}
