"""What goes together: a solver, a search, a heuristic, refinements to leave out, and an objective."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from types import MappingProxyType

from statehtn.core.heuristics import ADMISSIBLE, HEURISTICS, PORTFOLIO
from statehtn.core.searches import SEARCHES, TAKES
from statehtn.core.switches import LabelSwitches, SearchSwitches
from statehtn.expected import one_of
from statehtn.risk import AdditiveObjective, EntropicValueAtRisk, Keep, Neutral, Objective

SOLVERS: Mapping[str, str] = MappingProxyType(
    {
        "state": "A* progression search over states and task networks (paper Algorithm 4)",
        "plan": "A* search over task networks alone (paper Algorithms 1 to 3)",
    }
)
"""The solvers by name, with a line about each."""
HEURISTIC_CHOICES = (PORTFOLIO, *HEURISTICS)
"""What may be asked for as a heuristic."""
PRICE_SWITCHES = tuple(field.name for field in fields(SearchSwitches))
"""The refinements that the solver `state` can do without where the prices of actions add up."""
LABEL_SWITCHES = tuple(field.name for field in fields(LabelSwitches))
"""Those where they do not."""
SWEEP_SWITCHES = ("chords",)
"""Those of a sweep, beside its searches': bound all plans on an interval of alpha by chords, not by one end alone."""
SWITCHES = tuple(dict.fromkeys((*PRICE_SWITCHES, *LABEL_SWITCHES, *SWEEP_SWITCHES)))
"""All of them."""
NOTHING = "nothing"
"""What is left out of the complete search."""


def prices_add_up(wanted: Objective, keep: Sequence[Keep] = ()) -> bool:
    """Tell whether plans are compared by the sum of a price for each action, and by nothing else."""
    return not keep and isinstance(wanted, AdditiveObjective)


def switches_in(text: str) -> tuple[str, ...]:
    """Return the names in a text such as `endings+stubborn_sets`; none for `nothing`.

    Raises:
        UsageError: there is no such refinement.
    """
    return () if text == NOTHING else refinements(text.split("+"))


def refinements(names: Iterable[str]) -> tuple[str, ...]:
    """Return names of refinements.

    Raises:
        UsageError: one is none.
    """
    return tuple(one_of(name, SWITCHES, "refinement") for name in names)


def mismatch(
    solver: str,
    heuristic: str | None,
    search: str,
    without: Sequence[str] = (),
    wanted: Objective = Neutral(),
    keep: Sequence[Keep] = (),
) -> str | None:
    """Return why a solver does not take all of these together, None for its own heuristic; None if it does."""
    if (solver, search) not in TAKES:
        return f"the solver '{solver}' has no search but 'astar', found '{search}'"
    if without and solver != "state":
        return f"the solver '{solver}' has none of the refinements of 'state', found '{'+'.join(without)}'"
    by_labels = search != "greedy" and not _is_found_by_prices(wanted, keep)
    if not prices_add_up(wanted, keep) and (reason := _needs_prices(search, wanted, keep)):
        return reason
    has = LABEL_SWITCHES if by_labels else PRICE_SWITCHES
    has = (*has, *SWEEP_SWITCHES) if is_swept(wanted, keep) and search != "greedy" else has
    if lacking := [name for name in without if name in SWITCHES and name not in has]:
        return f"the search by '{wanted}' has no refinement '{lacking[0]}'; it has {', '.join(has)}"
    takes = heuristics_for(solver, search, wanted, keep)
    if heuristic is None or heuristic in takes:
        return None
    if solver == "plan":
        usable = " and ".join(takes)
        if heuristic in heuristics_for(solver, search):
            what = "with a budget to keep (--keep)" if keep else f"by '{wanted}'"
            return f"the solver 'plan' has the heuristic {usable} alone {what}, found '{heuristic}'"
        return f"the solver 'plan' has no state, which '{heuristic}' needs; its heuristics are {usable}"
    if heuristic == PORTFOLIO:
        if search in ("astar", "anytime"):
            return f"'{PORTFOLIO}' goes with objectives whose prices add up; take one of {', '.join(takes)}"
        searches = (name for name in SEARCHES if PORTFOLIO in TAKES[solver, name])
        return f"'{PORTFOLIO}' goes with the searches {' and '.join(searches)}, not with '{search}'"
    reason = misleads(heuristic, f"the search '{search}'")
    return f"{reason}, or '{heuristic}' with greedy search"


def is_swept(wanted: Objective, keep: Sequence[Keep]) -> bool:
    """Tell whether several searches by prices find the best plan together: by the entropic value at risk."""
    return not keep and isinstance(wanted, EntropicValueAtRisk)


def _is_found_by_prices(wanted: Objective, keep: Sequence[Keep]) -> bool:
    return prices_add_up(wanted, keep) or is_swept(wanted, keep)


def heuristics_for(
    solver: str, search: str, wanted: Objective = Neutral(), keep: Sequence[Keep] = ()
) -> tuple[str, ...]:
    """Return the heuristics that a search of a solver takes for an objective, first its own."""
    if search == "greedy" or _is_found_by_prices(wanted, keep):
        return TAKES[solver, search]
    # The solver `state` finds one plan as it finds the k best, and the bounds of `plan` are those of its labels.
    return TAKES["state", "top"] if solver == "state" else ("tdg",)


def _needs_prices(search: str, wanted: Objective, keep: Sequence[Keep]) -> str | None:
    """Say why a search does not take an objective, or a budget to keep, under which no prices add up; None if it does.

    Greedy search goes by the mean, and values what it finds; the first plan that it finds may keep no budget.
    """
    what = "a budget to keep (--keep)" if keep else f"the objective '{wanted}'"
    if search == "weighted":
        return f"the weighted search adds up prices of actions, which {what} does not have; take astar or anytime"
    if search == "greedy" and keep:
        return f"greedy search looks at no budgets; take astar or anytime with {what}"
    return None


def misleads(heuristic: str, search: str) -> str:
    """Say why a search that proves something does not take a heuristic."""
    return (
        f"'{heuristic}' may estimate more than is true, so that {search} could not keep what it promises; take one of "
        f"{', '.join(ADMISSIBLE)}"
    )
