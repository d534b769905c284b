"""Worths, bounds and comparisons of several sums in the core, against exact arithmetic."""

from __future__ import annotations

import decimal
import itertools
import math
from collections.abc import Callable
from decimal import Decimal

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import statehtn._relax as _relax
from tests.exact_disutility import ACTIONS, CONTEXT, ExactDisutility, few_actions, in_cost, mix_of, priced
from tests.shares import share_of_examples

SHARE = share_of_examples(3)

GROUNDING = few_actions()
PRECISION = Decimal("1e-12")
SIZES = st.floats(1e-3, 1e3)

slopes = st.one_of(st.floats(1e-3, 10), st.sampled_from([1e-12, 1e-9, 1e-6, 300.0]))
log_weights = st.one_of(st.floats(-20, 20), st.sampled_from([-5000.0, -300.0, 0.0, 600.0]))
falling = st.tuples(slopes.map(lambda slope: -slope), log_weights)
rising = st.tuples(slopes, log_weights)
sums = st.one_of(st.integers(0, 1 << 30), st.integers(0, 40).map(lambda bits: 1 << bits), st.just(0))


@st.composite
def disutilities(draw: st.DrawFn, is_convex: bool = False) -> ExactDisutility:
    linear = draw(st.one_of(st.just(1.0), st.just(0.0), st.sampled_from([1e-6, 1e6])))
    least = 0 if linear else 1
    terms = draw(st.lists(rising if is_convex else st.one_of(rising, falling), min_size=least, max_size=3))
    return ExactDisutility(linear, tuple(terms))


def is_well_conditioned(disutility: ExactDisutility) -> bool:
    """Where terms curve in both directions, the certainty equivalent may stand on digits that nobody has."""
    return len({slope > 0 for slope, _ in disutility.terms}) <= 1


class Ways:
    """Labels with these sums, one action each, beside a completion that is known in part."""

    def __init__(
        self,
        disutility: ExactDisutility,
        rows: list[list[int]],
        exponents: list[int],
        mixes: list[list[float]] | None = None,
        **switches: bool,
    ) -> None:
        options = _relax.FiniteOptions()
        for name, value in switches.items():
            setattr(options, name, value)
        self.exponents = exponents
        columns = [[row[price] for row in rows] for price in range(disutility.size)]
        handles = tuple(priced(GROUNDING, column) for column in columns)
        mixed = tuple((priced(GROUNDING, [mix_of(mix, row) for row in rows]), mix) for mix in mixes or ())
        self.core = _relax.ExponentialSums(handles, exponents, disutility.linear, disutility.terms, mixed, options)
        start = self.core.start()
        self.labels = [self.core.extend(start, action, []) for action in range(len(rows))]


def units(draw: st.DrawFn, size: int) -> list[int]:
    return draw(st.lists(sums, min_size=size, max_size=size))


@SHARE
@given(data=st.data(), disutility=disutilities())
def test_a_worth_is_the_certainty_equivalent_rounded_down(data: st.DataObject, disutility: ExactDisutility) -> None:
    row = data.draw(st.lists(sums, min_size=disutility.size, max_size=disutility.size))
    exponents = [data.draw(st.integers(0, 30)) for _ in row]
    ways = Ways(disutility, [row], exponents)
    point = in_cost(row, exponents)
    worth = Decimal(_relax.value_of(ways.core.worth(ways.labels[0])))
    assert min(point) * (1 - PRECISION) - max(point) * PRECISION <= worth <= max(point)
    bad = disutility.at(point)
    assert disutility.of(worth) <= bad
    if is_well_conditioned(disutility):
        size = 1 + max((abs(log) + abs(Decimal(slope)) * max(point) for slope, log in exact(disutility)), default=0)
        with decimal.localcontext(CONTEXT):
            assert disutility.of(worth + (max(point) * 4 + size * (max(point) - min(point))) * Decimal(2) ** -46) >= bad


def exact(disutility: ExactDisutility) -> list[tuple[Decimal, Decimal]]:
    return [(Decimal(slope), Decimal(log_weight)) for slope, log_weight in disutility.terms]


@pytest.mark.parametrize("digits", [10, 130, 4000])
def test_no_size_overflows(digits: int) -> None:
    """The disutility of the sum is a number of so many digits, and one that begins with so many zeros."""
    cost = round(digits * 2.302585)
    for log_weight, expected in ((0.0, cost), (-float(cost), None), (float(cost), cost)):
        ways = Ways(ExactDisutility(1.0, ((1.0, log_weight),)), [[0, cost], [cost, cost]], [0, 0])
        worths = [_relax.value_of(ways.core.worth(label)) for label in ways.labels]
        assert worths[1] == pytest.approx(cost, rel=1e-13)
        if expected:  # the linear term is lost beside it
            assert worths[0] == pytest.approx(expected, rel=0.01)
        else:  # cost + 1 = c + e^(c - cost)
            assert 0.5 < worths[0] < 1.0


@pytest.mark.parametrize("slope", [1e-6, 1e-9, 1e-12, 1e-15])
def test_small_slopes_lose_nothing(slope: float) -> None:
    """As e^(A c) / A tends to 1 / A + c, the agent becomes neutral between both sums, at half the weight each."""
    with decimal.localcontext(CONTEXT):
        log_weight = float(-Decimal(slope).ln())
    ways = Ways(ExactDisutility(1.0, ((slope, log_weight),)), [[1, 3]], [0, 0])
    assert _relax.value_of(ways.core.worth(ways.labels[0])) == pytest.approx(2 + slope * 5 / 4, rel=1e-12)


@SHARE
@given(data=st.data(), disutility=disutilities(is_convex=True), sizes=st.lists(SIZES, min_size=4, max_size=4))
def test_bounds_hold_of_every_completion(data: st.DataObject, disutility: ExactDisutility, sizes: list[float]) -> None:
    rows = data.draw(st.lists(sums, min_size=disutility.size, max_size=disutility.size))
    least = data.draw(st.lists(sums, min_size=disutility.size, max_size=disutility.size))
    more = data.draw(st.lists(sums, min_size=disutility.size, max_size=disutility.size))
    exponents = [data.draw(st.integers(0, 20))] * disutility.size
    mix = sizes[: disutility.size]
    ways = Ways(disutility, [rows], exponents, [mix])
    completion = [a + b for a, b in zip(least, more, strict=True)]
    ideal = ways.core.bound(ways.labels[0], [*least, 0])
    bound = ways.core.bound(ways.labels[0], [*least, mix_of(mix, completion)])
    assert ideal <= bound
    total = [a + b for a, b in zip(rows, completion, strict=True)]
    assert disutility.of(Decimal(_relax.value_of(bound))) <= disutility.at(in_cost(total, exponents))


@SHARE
@given(
    slope=st.floats(0.01, 1),
    log_weight=st.floats(-20, 3),
    point=st.tuples(st.integers(0, 20), st.integers(0, 20)),
    mix=st.tuples(SIZES, SIZES),
    rest=st.integers(1, 50),
)
def test_bounds_at_a_mix_are_the_least_there_is(
    slope: float, log_weight: float, point: tuple[int, int], mix: tuple[float, float], rest: int
) -> None:
    """No point on the line where the mix costs so much is less bad, and some of them are just as bad."""
    disutility = ExactDisutility(1.0, ((slope, log_weight),))
    exponent = 20
    row = [number << exponent for number in point]
    ways = Ways(disutility, [row], [exponent] * 2, [list(mix)])
    amount = rest << exponent
    bound = Decimal(_relax.value_of(ways.core.bound(ways.labels[0], [0, 0, amount])))

    def between(share: Decimal) -> list[Decimal]:
        return [point[0] + share * rest / Decimal(mix[0]), point[1] + (1 - share) * rest / Decimal(mix[1])]

    with decimal.localcontext(CONTEXT):
        least = min_on_line(lambda share: disutility.at(between(share)))
        assert disutility.of(bound) <= least
        assert disutility.of(bound * (1 + PRECISION) + PRECISION) >= least


def min_on_line(function: Callable[[Decimal], Decimal], steps: int = 100) -> Decimal:
    """The least value of a convex function between 0 and 1, and an error of some 10^-30."""
    low, high = Decimal(0), Decimal(1)
    for _ in range(steps):
        left, right = (2 * low + high) / 3, (low + 2 * high) / 3
        low, high = (low, right) if function(left) <= function(right) else (left, high)
    return function(low)


@SHARE
@given(
    data=st.data(),
    disutility=st.one_of(disutilities(is_convex=True), disutilities()),
    switches=st.fixed_dictionaries(
        {}, optional=dict.fromkeys(("compare_boxes", "compare_envelopes", "use_cutoff"), st.just(False))
    ),
    has_cutoff=st.booleans(),
)
def test_ways_that_are_as_good_are_with_every_completion(
    data: st.DataObject, disutility: ExactDisutility, switches: dict[str, bool], has_cutoff: bool
) -> None:
    count = data.draw(st.integers(2, ACTIONS - 1))
    small = st.integers(0, 60)
    vector = st.lists(small, min_size=disutility.size, max_size=disutility.size)
    rows, least = data.draw(st.lists(vector, min_size=count, max_size=count)), data.draw(vector)
    exponents = [data.draw(st.sampled_from([0, 3, 6]))] * disutility.size
    ways = Ways(disutility, rows, exponents, **switches)
    cutoff = None
    if has_cutoff:
        cutoff = data.draw(st.floats(0.5, 200))
        ways.core.set_cutoff(_relax.order_of(cutoff))
    *others, last = ways.labels
    if not ways.core.are_as_good(others, last, least):
        return
    for _ in range(8):
        completion = [a + b for a, b in zip(least, data.draw(vector), strict=True)]
        values = [
            disutility.at(in_cost([a + b for a, b in zip(row, completion, strict=True)], exponents)) for row in rows
        ]
        if cutoff is None or values[-1] < disutility.of(Decimal(cutoff)):
            assert min(values[:-1]) <= values[-1]


@example(lines=[(9, 1), (1, 9), (6, 6)], slope=0.5)
@SHARE
@given(
    lines=st.lists(st.tuples(st.integers(0, 30), st.integers(0, 30)), min_size=2, max_size=5), slope=st.floats(0.05, 2)
)
def test_the_envelope_leaves_out_all_that_it_can(lines: list[tuple[int, int]], slope: float) -> None:
    """A way that is kept is better than all others with some completion of its risk."""
    disutility = ExactDisutility(1.0, ((slope, 0.0),))
    ways = Ways(disutility, [list(line) for line in lines], [0, 0])
    *others, last = ways.labels
    is_superfluous = ways.core.are_as_good(others, last, [0, 0])
    with decimal.localcontext(CONTEXT):
        factors = [Decimal(mean) for mean, _ in lines], [(Decimal(slope) * risk).exp() for _, risk in lines]

        def height(line: int, t: Decimal) -> Decimal:
            return factors[0][line] + factors[1][line] * t

        crossings = [
            (factors[0][i] - factors[0][j]) / (factors[1][j] - factors[1][i])
            for i in range(len(lines))
            for j in range(i)
            if lines[i][1] != lines[j][1]
        ]
        inside = sorted({Decimal(1), *(t for t in crossings if t > 1)})
        probes = [*inside, *((a + b) / 2 for a, b in itertools.pairwise(inside)), inside[-1] * 2]
        margins = [min(height(i, t) for i in range(len(lines) - 1)) / height(len(lines) - 1, t) for t in probes]
        if is_superfluous:
            assert all(margin <= 1 for margin in margins)
        else:
            assert any(margin > 1 - Decimal("1e-9") for margin in margins)


def test_the_tangent_of_the_certainty_equivalent_is_no_bound() -> None:
    """Of two ways one costs 0 or 30, the other 22: half of the prices' tangent would be 29.4, and 22 is right."""
    disutility = ExactDisutility(1.0, ((1.0, -20.0),))
    with decimal.localcontext(CONTEXT):
        risky = (Decimal("0.9") + Decimal("0.1") * Decimal(30).exp()).ln()
    exponent = 30
    risky_row = [3 << exponent, int(risky * 2**exponent)]
    certain_row = [22 << exponent, 22 << exponent]
    ways = Ways(disutility, [risky_row, certain_row], [exponent] * 2)
    worths = [_relax.value_of(ways.core.worth(label)) for label in ways.labels]
    assert worths[1] == pytest.approx(22)
    assert worths[1] < worths[0] < 29.4
    # The tangent of the certainty equivalent at the ideal point, (3, 22), is far above what is right.
    ideal = Ways(disutility, [[3 << exponent, 22 << exponent]], [exponent] * 2)
    worth = _relax.value_of(ideal.core.worth(ideal.labels[0]))
    by_mean, by_risk = (slope / (1 + math.exp(worth - 20)) for slope in (1.0, math.exp(22 - 20)))
    tangents = [worth + (mean - 3) * by_mean + (risk - 22) * by_risk for mean, risk in ((3, float(risky)), (22, 22))]
    assert min(tangents) == pytest.approx(29.4, abs=0.05)
    # The mix of these slopes bounds the disutility, and the bound of it is right.
    mix = [1.0, math.exp(22 - 20)]
    mixed = Ways(disutility, [[0, 0]], [exponent] * 2, [mix])
    least = [3 << exponent, 22 << exponent, min(mix_of(mix, risky_row), mix_of(mix, certain_row))]
    bound = _relax.value_of(mixed.core.bound(mixed.labels[0], least))
    assert worths[1] >= bound > _relax.value_of(mixed.core.bound(mixed.labels[0], [*least[:2], 0]))
