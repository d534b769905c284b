"""Every search has the switches that it reads, under one name on both sides of the core, and no others."""

from __future__ import annotations

from dataclasses import fields

import pytest

import statehtn._relax as _relax
from statehtn.compatible import SOLVERS
from statehtn.core.finite_labels import SWITCHES
from statehtn.core.heuristics import HEURISTICS
from statehtn.core.searches import SEARCHES, TAKES
from statehtn.core.switches import (
    LabelSwitches,
    LawSwitches,
    ProgressionSwitches,
    SearchSwitches,
    TopSwitches,
    set_switches,
)

NO_SWITCHES = {"in_sequence", "when_due", "explores"}
"""What greedy search is asked for; it does change what is found."""


def switches_of(options: object) -> dict[str, bool]:
    """The options that are on or off."""
    values = {name: getattr(options, name) for name in dir(options) if not name.startswith("_")}
    return {name: value for name, value in values.items() if isinstance(value, bool) and name not in NO_SWITCHES}


@pytest.mark.parametrize(
    ("kind", "options"),
    [
        (SearchSwitches, _relax.FindPlansOptions),
        (ProgressionSwitches, _relax.GreedyOptions),
        (TopSwitches, _relax.LabelSearchOptions),
        (LawSwitches, _relax.LawOptions),
    ],
)
def test_switches_are_the_fields_of_the_core(
    kind: type[ProgressionSwitches] | type[LawSwitches], options: type
) -> None:
    everything_on = {field.name: True for field in fields(kind)}
    assert switches_of(options()) == everything_on
    off = options()
    set_switches(off, kind(**dict.fromkeys(everything_on, False)))
    assert not any(switches_of(off).values())


def test_switches_of_labels_of_several_sums() -> None:
    assert switches_of(_relax.FiniteOptions()) == dict.fromkeys(SWITCHES, True)
    assert set(SWITCHES) <= {field.name for field in fields(LabelSwitches)}


def test_a_search_takes_heuristics_that_there_are() -> None:
    assert {solver for solver, _ in TAKES} == set(SOLVERS)
    assert {search for solver, search in TAKES if solver == "state"} == {*SEARCHES, "top"}
    for (_, search), names in TAKES.items():
        assert set(names) <= {"auto", *HEURISTICS}
        assert len(set(names)) == len(names)
        if search != "greedy":
            assert all(name == "auto" or HEURISTICS[name].admissible for name in names)


def test_the_core_takes_heuristics_by_name() -> None:
    options = _relax.FindPlansOptions()
    options.heuristics = ["tdg", "potential"]
    assert options.heuristics == ["tdg", "potential"]
    with pytest.raises(ValueError, match="no such heuristic: lmcutt"):
        options.heuristics = ["lmcutt"]
    greedy = _relax.GreedyOptions()
    greedy.heuristic = "ff"
    assert greedy.heuristic == "ff"
