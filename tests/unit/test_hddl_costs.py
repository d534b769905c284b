"""Costs in HDDL: their forms, exact numbers, and what is refused."""

from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path

import pytest

from statehtn.errors import InputError, UnsupportedError
from statehtn.hddl import HddlWarning, read_hddl_text, write_hddl
from statehtn.model import (
    And,
    Arithmetic,
    Atom,
    CostBlock,
    Domain,
    Effect,
    Expression,
    FunctionTerm,
    Number,
    Parameter,
    Problem,
    TaskNetwork,
)
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.ground_cost import action_law
from statehtn.model.problem import Action

DECLARATIONS = (
    "(:types road) (:predicates (icy ?r - road) (late)) "
    "(:functions (total-cost) - number (slow ?r - road) (rate) - number (chance ?r - road) - number)"
)
INIT = "(= (slow r1) 2.5) (= (slow r2) 1e-3) (= (rate) -.5) (= (total-cost) 0)"
ICY = Atom("icy", ("?r",))
ONE = Number(Fraction(1))


def read(effect: str, init: str = INIT) -> Problem:
    domain = f"(define (domain d) {DECLARATIONS}\n(:action drive :parameters (?r - road) :effect {effect}))"
    problem = f"(define (problem p) (:objects r1 r2 - road) (:init {init}) (:htn) (:metric minimize (total-cost)))"
    return read_hddl_text(domain, problem)


def costs(effect: str) -> tuple[CostBlock, ...]:
    return read(effect).domain.actions["drive"].costs


def number(text: str) -> Number:
    return Number(Fraction(text))


@pytest.mark.parametrize(
    ("text", "expression"),
    [
        ("4", number("4")),
        ("0.1", number("1/10")),
        (".5", number("1/2")),
        ("5.", number("5")),
        ("+2.50", number("5/2")),
        ("1e-3", number("1/1000")),
        ("2.5E2", number("250")),
        ("1/3", number("1/3")),
        ("(slow ?r)", FunctionTerm("slow", ("?r",))),
        ("(rate)", FunctionTerm("rate")),
        ("(+ 1 (* 2 (slow ?r)) 3)", Arithmetic(
            "+", (number("1"), Arithmetic("*", (number("2"), FunctionTerm("slow", ("?r",)))), number("3"))
        )),
        ("(- (rate))", Arithmetic("-", (FunctionTerm("rate"),))),
        ("(- 5 2 1)", Arithmetic("-", (number("5"), number("2"), number("1")))),
    ],
)  # fmt: skip
def test_expressions(text: str, expression: Expression) -> None:
    assert costs(f"(increase (total-cost) {text})") == (CostBlock(((ONE, expression),)),)


def test_forms_of_blocks() -> None:
    read_costs = costs("""(and (increase (total-cost) 4)
      (probabilistic 0.8 (increase (total-cost) 2) 0.1 (and (increase (total-cost) 6) (increase (total-cost) 1)) 0.1 ())
      (when (icy ?r) (probabilistic (chance ?r) (and (increase (total-cost) 3)) (- 1 (chance ?r)) (and)))
      (when (late) (and (when (icy ?r) (increase (total-cost) 5)) (not (late)) (icy ?r)))
      (forall (?x - road) (when (icy ?x) (increase (total-cost) (slow ?x)))))""")
    chance = FunctionTerm("chance", ("?r",))
    zero = number("0")
    assert read_costs == (
        CostBlock(((ONE, number("4")),)),
        CostBlock(
            (
                (number("0.8"), number("2")),
                (number("0.1"), Arithmetic("+", (number("6"), number("1")))),
                (number("0.1"), zero),
            )
        ),
        CostBlock(((chance, number("3")), (Arithmetic("-", (ONE, chance)), zero)), ICY),
        CostBlock(((ONE, number("5")),), And((Atom("late"), ICY))),
        CostBlock(((ONE, FunctionTerm("slow", ("?x",))),), Atom("icy", ("?x",)), (Parameter("?x", ("road",)),)),
    )


def test_costs_and_facts_under_one_condition() -> None:
    action = read("(when (late) (and (increase (total-cost) 1) (not (late)) (icy ?r)))").domain.actions["drive"]
    assert action.effects == (Effect(Atom("late"), False, Atom("late")), Effect(ICY, True, Atom("late")))
    assert action.costs == (CostBlock(((ONE, ONE),), Atom("late")),)


def test_functions_and_their_values() -> None:
    problem = read("()")
    assert list(problem.domain.functions) == ["slow", "rate", "chance"]  # the total cost is known anyway
    assert problem.function_values == {
        ("slow", "r1"): Fraction(5, 2),
        ("slow", "r2"): Fraction(1, 1000),
        ("rate",): Fraction(-1, 2),
    }


@pytest.mark.parametrize(
    ("effect", "message"),
    [
        ("(increase (total-cost) -1)", "a cost must not be negative, found -1"),
        ("(increase (total-cost) (- 1 2))", "a cost must not be negative, found -1"),
        ("(increase (total-cost) (* -1e299 1e299))", "a cost must not be negative, found a number of more than 308"),
        ("(increase (total-cost))", "expected '(increase (total-cost) <expression>)'"),
        ("(increase (total-cost) much)", "expected a number or a function in parentheses, found 'much'"),
        ("(increase (total-cost) slow)", "functions stand in parentheses"),
        ("(increase (total-cost) 1e9999)", "the number '1e9999' is out of range"),
        ("(increase (total-cost) 1/0)", "expected a number"),
        ("(increase (total-cost) nan)", "expected a number"),
        ("(increase (total-cost) ())", "expected a number, a function or + - *, found '()'"),
        ("(increase (total-cost) (+))", "'+' needs an operand"),
        ("(increase (total-cost) (slwo ?r))", "unknown function 'slwo'; did you mean 'slow'?"),
        ("(increase (total-cost) (slow))", "function 'slow' takes 1 argument, found 0"),
        ("(increase (total-cost) (slow ?q))", "unknown variable '?q'"),
        ("(increase (total-cost ?r) 1)", "'total-cost' takes no arguments"),
        ("(probabilistic)", "expected pairs of a probability and an effect"),
        ("(probabilistic 0.5)", "expected pairs of a probability and an effect"),
        ("(probabilistic -0.5 ())", "a probability must not be negative, found -0.5"),
        ("(probabilistic 0.6 () 0.5 ())", "the probabilities of this block sum to 1.1, more than 1"),
        ("(probabilistic 1.5 () (rate) ())", "the probabilities of this block sum to 1.5, more than 1"),
        ("(probabilistic 1 late)", "expected an effect such as"),
    ],
)
def test_costs_that_are_wrong(effect: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        costs(effect)
    assert message in caught.value.message
    assert caught.value.place is not None
    assert caught.value.place.line == 2


@pytest.mark.parametrize(
    ("effect", "message"),
    [
        ("(probabilistic 0.5 (probabilistic 1 ()))", "that changes no facts can only increase (total-cost)"),
        ("(increase (rate) 1)", "only (total-cost) can be increased"),
        ("(decrease (total-cost) 1)", "numeric effects ('decrease') are not supported"),
        ("(assign (rate) 1)", "numeric effects ('assign') are not supported"),
        ("(oneof (late) ())", "non-deterministic effects"),
        ("(increase (total-cost) (/ 1 3))", "division is not supported"),
        ("(increase (total-cost) (total-cost))", "a cost cannot depend on the total cost"),
    ],
)
def test_costs_that_are_not_supported(effect: str, message: str) -> None:
    with pytest.raises(UnsupportedError) as caught:
        costs(effect)
    assert message in caught.value.message
    assert caught.value.place is not None


def test_missing_probability_costs_nothing_but_is_told() -> None:
    with pytest.warns(HddlWarning, match=r"domain:2:\d+: the probabilities of this block sum to 0.75"):
        costs("(probabilistic 0.75 (increase (total-cost) 2))")


def test_probabilities_may_miss_one_by_rounding() -> None:
    third = "0.33333333333"
    costs(f"(probabilistic {third} () {third} (increase (total-cost) 1) {third} (increase (total-cost) 2))")


@pytest.mark.parametrize(
    ("init", "message"),
    [
        ("(= (slow r1) 1) (= (slow r1) 2)", "the value of (slow r1) is given twice"),
        ("(= (slow r1) x)", "expected a number, found 'x'"),
        ("(= (slwo r1) 1)", "unknown function 'slwo'; did you mean 'slow'?"),
        ("(= (slow) 1)", "function 'slow' takes 1 argument, found 0"),
        ("(= (slow r9) 1)", "unknown object 'r9'"),
        ("(= r1 r2)", "expected '(= (<function> <objects>) <number>)'"),
        ("(= (slow r1))", "expected '(= (<function> <objects>) <number>)'"),
    ],
)
def test_values_that_are_wrong(init: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        read("()", init)
    assert message in str(caught.value)


def test_external_costs_cannot_be_written() -> None:
    action = Action("a", costs=(CostBlock((), external=lambda: 1.0),))
    problem = Problem("p", Domain("d", actions={"a": action}), network=TaskNetwork())
    with pytest.raises(UnsupportedError, match="action 'a' is a Python callable"):
        write_hddl(problem)


def test_the_examples_of_the_documentation() -> None:
    text = (Path(__file__).parents[2] / "docs" / "hddl-costs.md").read_text(encoding="utf-8")
    examples = re.findall(r"^```lisp[^\n]*\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
    assert len(examples) == 4
    for domain, problem in zip(examples[::2], examples[1::2], strict=True):
        assert read_hddl_text(domain, problem, strict=True).network.subtasks
    problem = read_hddl_text(*examples[:2])
    law = action_law(problem.domain.actions["drive"], ("mountain",), [[(2, ())]], problem)
    assert isinstance(law, CostDistribution)
    assert law.outcomes == ((0.4, 5.0), (0.4, 6.0), (0.1, 9.0), (0.1, 10.0))
