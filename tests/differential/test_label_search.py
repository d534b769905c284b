"""The search over labels finds what the search over nodes finds, where a label is one sum of prices."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import Status
from statehtn.core.grounding import ground
from statehtn.core.label_run import PRECISION
from statehtn.core.label_search import search_labels, search_networks_by_labels
from statehtn.core.search import find_plans, last_of
from statehtn.core.switches import LabelSwitches
from statehtn.model import Problem
from statehtn.risk import Utility
from tests.differential.oracles import LIMITS, must_cost, must_have_ended
from tests.strategies import problems, utilities

SWITCHES = (None, "inherit_h", "tdg_bound", "selective", "follow_forced", "networks")


@given(problem=problems(), utility=utilities(), variant=st.sampled_from(SWITCHES))
def test_one_price(problem: Problem, utility: Utility, variant: str | None) -> None:
    """Without one refinement, and by the plan-based solver."""
    grounding = ground(problem)
    expected = find_plans(grounding, utility, limits=LIMITS)
    if variant == "networks":
        found = last_of(search_networks_by_labels(grounding, utility, limits=LIMITS))
    else:
        switches = LabelSwitches(**({variant: False} if variant else {}))
        found = last_of(search_labels(grounding, utility, limits=LIMITS, switches=switches))
    must_have_ended(expected.stopped)
    must_have_ended(found.stopped)
    assert found.status is expected.status
    if expected.plan is not None:
        assert found.status is Status.OPTIMAL
        assert found.plan is not None
        assert found.lower_bound == pytest.approx(expected.lower_bound, rel=PRECISION, abs=PRECISION)
        must_cost(problem, found.plan, utility, expected.lower_bound)
