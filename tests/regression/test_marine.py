"""The diver and the glider: every attitude has its own plan, and every kind of planning decision matters to risk."""

from __future__ import annotations

import pytest

from statehtn.model import Plan
from statehtn.risk import utility_for
from tests.brute_force import optimal_risk_cost
from tests.regression.paper_tables import ADMISSIBLE_HEURISTICS, actions, problem, solve

AGENTS = [("averse", 0.3), ("averse", 0.1), ("neutral", None), ("seeking", 0.1), ("seeking", 0.3)]


def plan_of(instance: str, attitude: str, alpha: float | None) -> Plan:
    plan = solve("marine", instance, attitude, alpha).plan
    assert plan is not None
    return plan


@pytest.mark.parametrize(("attitude", "alpha"), AGENTS)
def test_every_heuristic_proves_the_optimum_that_brute_force_finds(attitude: str, alpha: float | None) -> None:
    expected = optimal_risk_cost(problem("marine", "p1"), utility_for(attitude, alpha), most_nodes=100_000)
    for heuristic in ADMISSIBLE_HEURISTICS:
        assert solve("marine", "p1", attitude, alpha, heuristic).risk_cost == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("attitude", "alpha", "expected_cost"),
    [("averse", 0.3, 40.0), ("averse", 0.1, 37.4), ("neutral", None, 36.4), ("seeking", 0.3, 39.6)],
)
def test_p1_expected_costs(attitude: str, alpha: float | None, expected_cost: float) -> None:
    assert solve("marine", "p1", attitude, alpha).expected_cost == pytest.approx(expected_cost)


def test_the_choice_of_a_method_depends_on_the_attitude() -> None:
    assert "dive-out" in actions(plan_of("p1", "seeking", 0.3))
    assert "dive-out-with-glider" in actions(plan_of("p1", "neutral", None))
    assert "go-with-glider" in actions(plan_of("p1", "averse", 0.3))
    assert "go-without-glider" in actions(plan_of("p1", "neutral", None))


def test_the_binding_of_glider_and_landing_place_depends_on_the_attitude() -> None:
    def objects(attitude: str, alpha: float | None) -> set[str]:
        return {name for step in plan_of("p1", attitude, alpha).steps for name in step.arguments}

    assert objects("averse", 0.3) & {"glider1", "glider2"} == {"glider1"}
    assert objects("neutral", None) & {"glider1", "glider2"} == {"glider2"}
    assert "jetty" in objects("averse", 0.1)  # a calm way home ...
    assert "jetty" not in objects("neutral", None)  # ... that is longer on average


def test_the_order_of_going_home_and_reporting_depends_on_the_attitude() -> None:
    def ending(attitude: str, alpha: float | None) -> tuple[str, ...]:
        names = actions(plan_of("p1", attitude, alpha))
        return names[len(names) - names[::-1].index("collect-beside-glider") :]

    # The glider that brings the diver home first reports from the shore; otherwise it reports from the surface.
    assert ending("averse", 0.3) == ("go-with-glider", "transmit")
    assert set(ending("neutral", None)) == {"move-to-surface", "transmit", "go-without-glider"}


def test_p2_has_another_plan_for_each_attitude() -> None:
    averse, neutral, seeking = (
        plan_of("p2", attitude, alpha) for attitude, alpha in (("averse", 0.3), ("neutral", None), ("seeking", 0.3))
    )

    def landings(plan: Plan) -> list[str]:
        return [step.arguments[-1] for step in plan.steps if step.action.startswith("go-")]

    assert actions(averse).count("dive-out-with-glider") == 3
    assert actions(neutral) == actions(seeking)
    assert landings(neutral) == ["jetty", "jetty", "cove"]
    assert landings(seeking) == ["jetty", "cove", "cove"]
