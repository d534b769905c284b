"""Who decomposes, achieves and leads to what, in the lifted problem."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property

from statehtn.model import Action, Effect, Method, Problem


@dataclass(frozen=True)
class Lookup:
    """What reasons look up in a problem."""

    problem: Problem

    @cached_property
    def methods_of(self) -> dict[str, list[Method]]:
        """The methods of every task."""
        found: defaultdict[str, list[Method]] = defaultdict(list)
        for method in self.problem.domain.methods.values():
            found[method.task].append(method)
        return found

    @cached_property
    def achievers(self) -> dict[str, list[tuple[Action, Effect]]]:
        """The actions that make facts of a predicate true, with the effects that do."""
        found: defaultdict[str, list[tuple[Action, Effect]]] = defaultdict(list)
        for action in self.problem.domain.actions.values():
            for effect in action.all_effects:
                if effect.positive:
                    found[effect.atom.predicate].append((action, effect))
        return found

    @cached_property
    def reachable(self) -> set[str]:
        """The tasks that the initial network leads to, whatever the arguments."""
        found = {subtask.task for subtask in self.problem.network.subtasks}
        pending = list(found)
        while pending:
            for method in self.methods_of[pending.pop()]:
                new = {subtask.task for subtask in method.network.subtasks} - found
                found |= new
                pending += new
        return found
