"""Where a way is as good as another one over scenarios, it is so with every completion, however that hangs together."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn._relax as _relax
from statehtn.core.grounding import ground
from statehtn.core.scenario_labels import ScenarioLabels
from statehtn.core.switches import LabelSwitches
from statehtn.limits import Limits
from statehtn.risk.keep import Keep
from statehtn.risk.objectives import objective
from tests.all_laws import Budget
from tests.lotteries import ALPHAS, FINITE, LAWS, SWEPT, budgets, texts
from tests.scenarios import correlated_lotteries, hedging_problems
from tests.strategies import Draw, between

NO_WORTH = 2**63 - 1
EXPONENTIAL = (texts(("averse ", "seeking "), ALPHAS), FINITE["one-switch"], FINITE["exponentials"])
TEXTS = st.one_of(*LAWS.values(), *SWEPT.values(), *EXPONENTIAL, st.just("neutral"))
PROBLEMS = {
    "laws": st.one_of(hedging_problems(certain=False), correlated_lotteries()),
    "totals": st.one_of(hedging_problems(), correlated_lotteries(certain=True)),
}
Execution = tuple[int, tuple[int, ...]]
"""An action, and the parts of its cost that are due."""


class Ways:
    """Ways whose costs hang together: actions in any number, whatever a state would allow."""

    def __init__(self, labels: ScenarioLabels) -> None:
        self.labels = labels
        self.valuation = labels.valuation
        grounding = labels.grounding
        self.parts = [tuple(range(*grounding.handle.cost_parts(one))) for one in range(grounding.action_count)]

    def after(self, value: int, executions: list[Execution]) -> int:
        for action, parts in executions:
            value = self.valuation.extend(value, action, parts)
        return value

    def least(self, executions: list[Execution]) -> list[int]:
        """What they cost at least at the valuation's prices: nothing is said of tangents, all of the scenarios."""
        by_scenario = [
            sum(
                int(grid._laws[number][0][0])
                for action, parts in executions
                for number in (grid._actions[action], *(grid._parts[part] for part in parts))
            )
            for grid in self.labels._grids
        ]
        return [*([0] * len(self.labels._tangents)), *by_scenario]


@st.composite
def executions(draw: Draw, ways: Ways, most: int) -> list[Execution]:
    """Some actions, each with some of the parts of its cost."""
    actions = draw(st.lists(st.integers(0, len(ways.parts) - 1), min_size=1, max_size=most))
    return [(one, tuple(part for part in ways.parts[one] if draw(st.booleans()))) for one in actions]


@pytest.mark.parametrize("kind", PROBLEMS)
def test_ways_that_are_as_good_are_with_every_completion(kind: str) -> None:
    seen = 0  # comparisons that say that a way is as good as another one of a different value

    @given(data=st.data(), text=TEXTS, keep=st.one_of(st.just(()), budgets()))
    def compare(data: st.DataObject, text: str, keep: tuple[Budget, ...]) -> None:
        nonlocal seen
        grounding = ground(data.draw(PROBLEMS[kind]))
        if not grounding.handle.solvable or not grounding.action_count:
            return
        kept = [Keep(float(budget), float(probability)) for budget, probability in keep]
        ways = Ways(ScenarioLabels(grounding, objective(text), kept, LabelSwitches(), Limits()))
        number = between(data.draw, 2, 4)
        spent = [ways.after(ways.valuation.start(), data.draw(executions(ways, most=3))) for _ in range(number)]
        to_come = data.draw(executions(ways, most=2))
        least = ways.least(to_come)
        ends = {value: ways.valuation.worth(ways.after(value, to_come)) for value in spent}
        for one, worth in ends.items():
            bound = ways.valuation.bound(one, least, 0)
            assert bound <= worth or math.isclose(_relax.value_of(bound), _relax.value_of(worth), rel_tol=1e-10)
            for other, other_worth in ends.items():
                if one != other and ways.valuation.are_as_good([one], other, least):
                    seen += worth != other_worth
                    assert other_worth == NO_WORTH or worth != NO_WORTH
                    value, other_value = map(_relax.value_of, (worth, other_worth))
                    assert other_worth == NO_WORTH or value <= other_value + 1e-10 * max(1.0, abs(other_value))

    compare()
    assert seen >= 5
