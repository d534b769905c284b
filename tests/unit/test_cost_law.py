"""Cost blocks of ground actions: expressions, probabilities, parts that add up, external costs, and errors."""

from __future__ import annotations

import math
import re
import warnings
from fractions import Fraction

import pytest

from statehtn.errors import InputError, Place
from statehtn.model import (
    Action,
    Arithmetic,
    Atom,
    CostBlock,
    CostDistribution,
    CostLaw,
    CostSum,
    Domain,
    Expression,
    FunctionTerm,
    Number,
    Parameter,
    Problem,
)
from statehtn.model.cost.expressions import evaluate
from statehtn.model.cost.ground_cost import action_law, block_law
from statehtn.model.cost.numerics.exponential_mean import exponential_mean_of
from statehtn.model.cost.probabilities import CostWarning

VALUES = {("slow", "a", "b"): Fraction(6), ("fast", "a", "b"): Fraction(2), ("jam",): Fraction(1, 4)}
FROM_TO = (Parameter("?a"), Parameter("?b"))


def number(value: str | int) -> Number:
    return Number(Fraction(value))


def block(*branches: tuple[Expression | str | int, Expression | str | int]) -> CostBlock:
    def expression(value: Expression | str | int) -> Expression:
        return number(value) if isinstance(value, str | int) else value

    return CostBlock(tuple((expression(probability), expression(cost)) for probability, cost in branches))


def drive(*costs: CostBlock) -> Action:
    return Action("drive", FROM_TO, costs=costs)


def whole_law(action: Action, parts: list[tuple[int, tuple[str, ...]]] | None = None) -> CostLaw:
    priced = Action("wait", costs=(block((1, 1)),))
    problem = Problem("p", Domain("d", actions={"drive": action, "wait": priced}), function_values=VALUES)
    return action_law(action, ("a", "b"), [parts or []], problem)


def law_of(
    *costs: CostBlock, parts: list[tuple[int, tuple[str, ...]]] | None = None
) -> tuple[tuple[float, float], ...]:
    law = whole_law(drive(*costs), parts)
    assert isinstance(law, CostDistribution)
    return law.outcomes


def test_expressions_are_exact() -> None:
    slow, fast = FunctionTerm("slow", ("?a", "?b")), FunctionTerm("fast", ("?a", "b"))
    bindings = {"?a": "a", "?b": "b"}
    assert evaluate(number("0.1"), bindings, VALUES) == Fraction(1, 10)
    assert evaluate(Arithmetic("+", (slow, fast, number("0.1"))), bindings, VALUES) == Fraction(81, 10)
    assert evaluate(Arithmetic("*", (slow, fast, FunctionTerm("jam"))), bindings, VALUES) == 3
    assert evaluate(Arithmetic("-", (slow, fast)), bindings, VALUES) == 4
    assert evaluate(Arithmetic("-", (slow,)), bindings, VALUES) == -6
    assert evaluate(Arithmetic("+", ()), bindings, VALUES) == 0


def test_a_missing_value_is_named_with_its_arguments_and_the_action() -> None:
    with pytest.raises(InputError, match=re.escape("the value of (slow b a) is not defined; add (= (slow b a)")):
        evaluate(FunctionTerm("slow", ("?b", "?a")), {"?a": "a", "?b": "b"}, VALUES)
    with pytest.raises(InputError, match=re.escape("the cost of (drive a b): the value of (toll) is not defined")):
        law_of(block((1, FunctionTerm("toll"))))


def test_one_block() -> None:
    slow, fast, jam = FunctionTerm("slow", ("?a", "?b")), FunctionTerm("fast", ("?a", "?b")), FunctionTerm("jam")
    free = Arithmetic("-", (number(1), jam))
    assert law_of(block((jam, slow), (free, fast))) == ((0.75, 2.0), (0.25, 6.0))
    assert block_law(block((jam, slow), (free, fast)), drive(), ("a", "b"), (), VALUES).mean == 3.0


def test_an_action_without_blocks_is_free_unless_costs_are_units() -> None:
    assert law_of() == ((1.0, 0.0),)
    without_costs = Problem("p", Domain("d", actions={"drive": drive()}))
    assert action_law(drive(), ("a", "b"), [()], without_costs) == CostDistribution.certain(1)


def test_independent_blocks_are_convolved_and_equal_costs_merged() -> None:
    coin = block(("0.5", "0.1"), ("0.5", "0.2"))
    assert law_of(coin, coin) == ((0.25, 0.2), (0.5, 0.3), (0.25, 0.4))
    assert law_of(block((1, "0.1")), block((1, "0.2"))) == ((1.0, 0.3),)
    many = [coin] * 200
    assert len(law_of(*many)) == 201


def test_conditional_parts_count_where_they_are_due() -> None:
    icy = CostBlock(((number(1), number(3)),), condition=Atom("icy", ("?b",)))
    each = CostBlock(((number(1), FunctionTerm("slow", ("?x", "?y"))),), parameters=(Parameter("?x"), Parameter("?y")))
    base = block((1, 4))
    assert law_of(base, icy, each) == ((1.0, 4.0),)
    assert law_of(base, icy, each, parts=[(1, ())]) == ((1.0, 7.0),)
    assert law_of(base, icy, each, parts=[(1, ()), (2, ("a", "b")), (2, ("a", "b"))]) == ((1.0, 19.0),)


def test_missing_probability_costs_nothing() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # constant probabilities: the reader has warned
        assert law_of(block(("0.25", 8))) == ((0.75, 0.0), (0.25, 8.0))
    with pytest.warns(CostWarning, match="action 'drive' sum to less than 1"):
        assert law_of(block((FunctionTerm("jam"), 8))) == ((0.75, 0.0), (0.25, 8.0))


def test_probabilities_may_be_rounded() -> None:
    thirds = block(*[("0.3333333333", cost) for cost in (1, 2, 3)])
    outcomes = law_of(thirds)
    assert [cost for _, cost in outcomes] == [1.0, 2.0, 3.0]
    assert sum(probability for probability, _ in outcomes) == pytest.approx(1, abs=1e-15)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (block(("0.6", 1), ("0.6", 2)), "the probabilities of the cost of (drive a b) sum to 1.2, more than 1"),
        (block(("-0.5", 1), (1, 2)), "the cost of (drive a b): a probability must not be negative, found -0.5"),
        (block((1, "-3")), "the cost of (drive a b): a cost must not be negative, found -3"),
        (block((1, Arithmetic("-", (number(1), number(2))))), "a cost must not be negative, found -1"),
        (block((1, "1e400")), "the cost of (drive a b) is too large"),
    ],
)
def test_wrong_blocks_name_the_ground_action(wrong: CostBlock, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        law_of(wrong)


def test_impossible_branches_do_not_matter() -> None:
    assert law_of(block((0, FunctionTerm("toll")), (1, 2))) == ((1.0, 2.0),)


def test_external_costs_get_the_action_s_objects() -> None:
    def fare(origin: str, destination: str) -> float:
        return {"a": 1.5, "b": 2.5}[origin] + len(destination)

    def traffic(*_: str) -> CostDistribution:
        return CostDistribution.of([(0.5, 0.1), (0.5, 0.2)])

    assert law_of(CostBlock((), external=fare)) == ((1.0, 2.5),)
    assert law_of(CostBlock((), external=traffic), block((1, "0.1"))) == ((0.5, 0.2), (0.5, 0.3))


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (-1.0, "a cost must not be negative, found -1"),
        (float("nan"), "must be finite"),
        ("3", "must be a number or CostDistribution, found '3'"),
        (None, "must be a number or CostDistribution, found None"),
    ],
)
def test_wrong_external_costs_name_the_ground_action(answer: object, message: str) -> None:
    with pytest.raises(InputError, match=re.escape("cost of (drive a b)")) as error:
        law_of(CostBlock((), external=lambda *_: answer))
    assert message in str(error.value)


def test_parts_with_too_many_combinations_stay_parts_and_their_prices_add_up() -> None:
    def parts(count: int) -> list[CostBlock]:
        return [block(("0.25", 3**power), ("0.75", 0)) for power in range(count)]

    law = whole_law(drive(block((1, 1)), *parts(60), block((1, 2))))
    assert isinstance(law, CostSum)
    assert len(law.parts) == 61  # what is certain is one part
    assert str(law) == "61 independent parts, from 3 to 2.11956e+28"
    assert law.mean == pytest.approx(3 + (3**60 - 1) / 8, rel=1e-15)

    sums = whole_law(drive(*parts(10)))
    assert isinstance(sums, CostSum)
    multiplied = sums.total
    assert isinstance(multiplied, CostDistribution)
    assert len(multiplied.outcomes) == 2**10
    for slope in (0.1, -0.1, 1e-6):
        assert sums.exponential_mean(slope) == pytest.approx(multiplied.exponential_mean(slope), rel=1e-13)
    assert sums.standard_deviation == pytest.approx(multiplied.standard_deviation, rel=1e-13)
    assert sums.quantile(0.9) == multiplied.quantile(0.9)


@pytest.mark.parametrize("slope", [1e-12, 0.5, 900.0, -1e-12, -0.5, -900.0])
def test_many_outcomes_are_priced_as_few_are(slope: float) -> None:
    costs = [1 + number / 1000 for number in range(1500)]
    weights = [1.0 + number % 7 for number in range(1500)]
    law = CostDistribution.of((weight / sum(weights), cost) for weight, cost in zip(weights, costs, strict=True))
    pieces = []
    for start in range(0, 1500, 100):
        probabilities, outcomes = zip(*law.outcomes[start : start + 100], strict=True)
        weight = math.fsum(probabilities)
        mean = math.fsum(p * cost for p, cost in law.outcomes[start : start + 100]) / weight
        pieces.append((weight, exponential_mean_of(probabilities, outcomes, mean, slope)))
    weights, means = ([piece[index] for piece in pieces] for index in (0, 1))
    together = exponential_mean_of(weights, means, law.mean, slope)
    assert law.exponential_mean(slope) == pytest.approx(together, rel=1e-12)


def test_a_cost_that_is_too_large_to_be_added_up_is_an_error_with_its_place() -> None:
    place = Place("d.hddl", 4, 9)
    large = CostBlock(((number(1), number(10**300)),), place=place)
    with pytest.raises(InputError, match=r"d\.hddl:4:9: the cost of \(drive a b\) can be 1e\+300, .* larger unit"):
        law_of(block((1, 1)), large)
    with pytest.raises(InputError, match="too large"):
        whole_law(drive(CostBlock((), law=CostDistribution.certain(1e300))))
