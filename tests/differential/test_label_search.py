"""The search over labels finds what the search over nodes finds, where a label is one sum of prices."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import Status
from statehtn.core.grounding import ground
from statehtn.core.label_search import PRECISION, search_labels
from statehtn.core.search import find_plans, last_of
from statehtn.core.switches import LabelSwitches
from statehtn.model import Problem
from statehtn.risk import Utility
from tests.differential.oracles import LIMITS, must_cost, must_have_ended
from tests.strategies import problems, utilities


@given(problem=problems(), utility=utilities(), left_out=st.sampled_from([None, "inherit_h", "tdg_bound"]))
def test_one_price(problem: Problem, utility: Utility, left_out: str | None) -> None:
    grounding = ground(problem)
    expected = find_plans(grounding, utility, limits=LIMITS)
    switches = LabelSwitches(**({left_out: False} if left_out else {}))
    found = last_of(search_labels(grounding, utility, limits=LIMITS, switches=switches))
    must_have_ended(expected.stopped)
    must_have_ended(found.stopped)
    assert found.status is expected.status
    if expected.plan is not None:
        assert found.status is Status.OPTIMAL
        assert found.plan is not None
        assert found.lower_bound == pytest.approx(expected.lower_bound, rel=PRECISION, abs=PRECISION)
        must_cost(problem, found.plan, utility, expected.lower_bound)
