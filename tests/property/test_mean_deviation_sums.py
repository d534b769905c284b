"""Worths, bounds and comparisons of means and variances in the core, against exact arithmetic."""

from __future__ import annotations

import decimal
from decimal import Decimal

from hypothesis import given
from hypothesis import strategies as st

import statehtn._relax as _relax
from tests.exact_disutility import ACTIONS, CONTEXT, few_actions, in_cost, mix_of, priced
from tests.shares import share_of_examples

SHARE = share_of_examples(3)

GROUNDING = few_actions()
PRECISION = Decimal("1e-13")
Pair = tuple[int, int]

weights = st.one_of(st.floats(0.01, 100), st.sampled_from([1e-9, 1.0, 1e6]))
pairs = st.tuples(st.integers(0, 1 << 40), st.integers(0, 1 << 40))
small_pairs = st.tuples(st.integers(0, 60), st.integers(0, 60))
switches = st.fixed_dictionaries(
    {}, optional=dict.fromkeys(("compare_boxes", "compare_envelopes", "use_cutoff"), st.just(False))
)


class Ways:
    """Labels with these means and variances, one action each."""

    def __init__(
        self, weight: float, rows: list[Pair], exponents: Pair, mix: list[float] | None = None, **off: bool
    ) -> None:
        options = _relax.FiniteOptions()
        for name, value in off.items():
            setattr(options, name, value)
        self.weight, self.exponents = weight, exponents
        means, variances = (priced(GROUNDING, [row[price] for row in rows]) for price in range(2))
        mixes = () if mix is None else ((priced(GROUNDING, [mix_of(mix, row) for row in rows]), mix),)
        self.core = _relax.MeanDeviation(weight, means, variances, *exponents, mixes, options)
        start = self.core.start()
        self.labels = [self.core.extend(start, action, []) for action in range(len(rows))]

    def value(self, *pairs_of_units: Pair) -> Decimal:
        """The value of the sum of these."""
        with decimal.localcontext(CONTEXT):
            total = [sum(pair[price] for pair in pairs_of_units) for price in range(2)]
            mean, variance = in_cost(total, self.exponents)
            return mean + Decimal(self.weight) * variance.sqrt()


@SHARE
@given(weight=weights, row=pairs, exponents=st.tuples(st.integers(0, 40), st.integers(0, 40)))
def test_a_worth_is_the_value_rounded_down(weight: float, row: Pair, exponents: Pair) -> None:
    ways = Ways(weight, [row], exponents)
    worth = Decimal(_relax.value_of(ways.core.worth(ways.labels[0])))
    value = ways.value(row)
    assert value * (1 - PRECISION) <= worth <= value


@SHARE
@given(
    weight=weights,
    row=pairs,
    least=pairs,
    more=pairs,
    mix=st.lists(st.floats(1e-3, 1e3), min_size=2, max_size=2),
)
def test_bounds_hold_of_every_completion(weight: float, row: Pair, least: Pair, more: Pair, mix: list[float]) -> None:
    ways = Ways(weight, [row], (20, 20), mix)
    completion = (least[0] + more[0], least[1] + more[1])
    ideal = ways.core.bound(ways.labels[0], [*least, 0])
    bound = ways.core.bound(ways.labels[0], [*least, mix_of(mix, completion)])
    assert ideal <= bound
    assert Decimal(_relax.value_of(bound)) <= ways.value(row, completion)


@SHARE
@given(weight=weights, row=pairs, more=pairs, mix=st.lists(st.floats(1e-3, 1e3), min_size=2, max_size=2))
def test_a_bound_at_a_mix_is_attained(weight: float, row: Pair, more: Pair, mix: list[float]) -> None:
    """The bound is the value of what costs as much at the mix, all of it in the mean or all of it in the variance."""
    ways = Ways(weight, [row], (0, 0), mix)
    rest = mix_of(mix, more)
    bound = Decimal(_relax.value_of(ways.core.bound(ways.labels[0], [0, 0, rest])))
    with decimal.localcontext(CONTEXT):
        mean, variance = row[0] + rest / Decimal(mix[0]), row[1] + rest / Decimal(mix[1])
        ends = [mean + Decimal(weight) * Decimal(row[1]).sqrt(), row[0] + Decimal(weight) * variance.sqrt()]
        assert min(ends) * (1 - PRECISION) <= bound <= min(ends)


@SHARE
@given(
    data=st.data(),
    weight=st.floats(0.1, 10),
    rows=st.lists(small_pairs, min_size=2, max_size=ACTIONS - 1),
    least=small_pairs,
    exponents=st.tuples(st.sampled_from([0, 2, 4]), st.sampled_from([0, 2, 4])),
    off=switches,
    cutoff=st.none() | st.floats(0.5, 200),
)
def test_ways_that_are_as_good_are_with_every_completion(
    data: st.DataObject,
    weight: float,
    rows: list[Pair],
    least: Pair,
    exponents: Pair,
    off: dict[str, bool],
    cutoff: float | None,
) -> None:
    ways = Ways(weight, rows, exponents, **off)
    if cutoff is not None:
        ways.core.set_cutoff(_relax.order_of(cutoff))
    *others, last = ways.labels
    if not ways.core.are_as_good(others, last, list(least)):
        return
    for more in data.draw(st.lists(small_pairs, min_size=8, max_size=8)):
        completion = (least[0] + more[0], least[1] + more[1])
        values = [ways.value(row, completion) for row in rows]
        if cutoff is None or values[-1] < Decimal(cutoff):
            assert min(values[:-1]) <= values[-1]


def test_more_is_left_out_than_by_comparing_sums() -> None:
    """A lower mean makes up for a variance that is a little larger, if much of it is still to come."""
    ways = Ways(1.0, [(0, 10), (1, 4)], (0, 0))
    low, high = ways.labels
    assert not ways.core.are_as_good([low], high, [0, 0])
    assert ways.core.are_as_good([low], high, [0, 10])  # sqrt(20) - sqrt(14) < 1
    assert not Ways(1.0, [(0, 10), (1, 4)], (0, 0), compare_boxes=False).core.are_as_good([low], high, [0, 10])


def test_several_ways_make_one_superfluous_that_none_of_them_does() -> None:
    """The one with the low mean is better where much variance is to come, the other where little is."""
    rows = [(0, 16), (10, 0), (9, 2)]
    ways = Ways(4.0, rows, (0, 0))
    first, second, third = ways.labels
    assert not ways.core.are_as_good([first], third, [0, 0])
    assert not ways.core.are_as_good([second], third, [0, 0])
    assert ways.core.are_as_good([first, second], third, [0, 0])
    alone = Ways(4.0, rows, (0, 0), compare_envelopes=False)
    assert not alone.core.are_as_good(alone.labels[:2], alone.labels[2], [0, 0])
