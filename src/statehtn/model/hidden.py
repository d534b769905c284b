"""Who may read hidden facts, and which scenarios the condition of a cost tells from each other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from statehtn.errors import UnsupportedError
from statehtn.model.chance import Chance
from statehtn.model.formula import predicates
from statehtn.model.problem import Problem

ONLY_COSTS = "it is decided by chance in ':init' and never seen, so that only conditions of costs may read it"


def hidden_predicates(chances: Iterable[Chance]) -> frozenset[str]:
    """Return the predicates of hidden facts: all facts of such a predicate are read by costs alone."""
    return frozenset(fact[0] for chance in chances for fact in chance.facts)


def check_that_costs_alone_read(problem: Problem) -> None:
    """Refuse a problem in which anything but the condition of a cost reads or writes a hidden fact.

    Raises:
        UnsupportedError: names what does.
    """
    hidden = hidden_predicates(problem.chances)
    for what, predicate in _users(problem) if hidden else ():
        if predicate in hidden:
            raise UnsupportedError(f"{what} a fact of '{predicate}'; {ONLY_COSTS}")


def _users(problem: Problem) -> Iterator[tuple[str, str]]:
    """Yield all that reads or writes facts, but for costs, with the predicates."""
    for action in problem.domain.actions.values():
        name = f"action '{action.name}'"
        yield from ((f"the precondition of {name} reads", found) for found in predicates(action.precondition))
        for effect in action.all_effects:
            yield f"an effect of {name} changes", effect.atom.predicate
            yield from ((f"an effect of {name} depends on", found) for found in predicates(effect.condition))
    for method in problem.domain.methods.values():
        what = f"the precondition of method '{method.name}' reads"
        yield from ((what, found) for found in predicates(method.precondition))
    yield from (("the goal reads", found) for found in predicates(problem.goal))
