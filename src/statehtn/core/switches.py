"""Refinements of the search that can be left out."""

from __future__ import annotations

from dataclasses import dataclass, fields

import statehtn._relax as _relax


@dataclass(frozen=True, slots=True)
class SearchSwitches:
    """Refinements of the search that change its effort but never its optimum."""

    tdg_bound: bool = True
    """Bound every node by the decomposition graph before the heuristic is asked (not with `blind`)."""
    inherit_h: bool = True
    """A node's h is at least its parent's less the cost of the step between them."""
    selective: bool = True
    """Ask an admissible heuristic rarely while it tells no more than the cheap bounds."""
    skip_dead_methods: bool = True
    """Leave out methods whose first task would come next and cannot be executed."""
    stubborn_sets: bool = True
    """Leave out actions that can wait: their order with the others makes no difference."""
    forget_facts: bool = True
    """States keep only the facts that something still to be done may read."""
    endings: bool = True
    """Leave out networks in partial order whose last actions cannot be executed in any order."""
    merge_sequences: bool = True
    """Networks in total order are the same if they differ in actions in a row that need and change the same."""
    learn_branching: bool = True
    """Decompose the compound task whose decompositions have survived least so far, not that with the fewest methods."""
    follow_forced: bool = True
    """Pass through nodes that have but one way to go on, as long as f stays as it is."""

    def apply(self, options: _relax.SearchOptions) -> None:
        """Hand them over to the core."""
        for switch in fields(self):
            setattr(options, switch.name, getattr(self, switch.name))
