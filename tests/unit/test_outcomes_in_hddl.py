"""Actions with several outcomes: how HDDL states them, and what is refused."""

from __future__ import annotations

import warnings
from fractions import Fraction

import pytest

import statehtn
from statehtn.errors import InputError, UnsupportedError
from statehtn.hddl.diagnostics import HddlWarning
from statehtn.hddl.reader import read_hddl_text
from statehtn.model import (
    TRUE,
    Action,
    And,
    Arithmetic,
    Atom,
    CostBlock,
    Effect,
    Number,
    Outcome,
    OutcomeBlock,
    Parameter,
    Problem,
)

PROBLEM = """(define (problem p) (:domain d) (:objects a b - block)
  (:htn :subtasks (grasp a)) (:init (= (p-slip a) 0.25) (= (p-slip b) 0.5)))"""


def read(effect: str, init: str = "") -> Problem:
    """Return a problem whose one action has this effect."""
    domain = f"""(define (domain d) (:types block)
  (:predicates (held ?b - block) (wet ?b - block) (broken) (icy)) (:functions (p-slip ?b - block) - number)
  (:action grasp :parameters (?b - block) :effect {effect}))"""
    return read_hddl_text(domain, PROBLEM.replace("(:init", f"(:init {init}"))


def grasp(effect: str) -> Action:
    """Return the action with this effect."""
    return read(effect).domain.actions["grasp"]


def number(value: str) -> Number:
    """Return a number as an expression."""
    return Number(Fraction(value))


def increase(value: str) -> CostBlock:
    """Return a certain cost."""
    return CostBlock(((number("1"), number(value)),))


HELD = Effect(Atom("held", ("?b",)))
BROKEN = Effect(Atom("broken"))


def test_facts_and_costs_of_an_outcome_stay_together() -> None:
    found = grasp("(probabilistic 0.8 (held ?b) 0.2 (and (increase (total-cost) 3) (not (held ?b)) (broken)))")
    outcomes = (
        Outcome(number("0.8"), (HELD,)),
        Outcome(number("0.2"), (Effect(HELD.atom, positive=False), BROKEN), (increase("3"),)),
    )
    assert found.outcomes == (OutcomeBlock(outcomes),)
    assert (found.effects, found.costs) == ((), ())
    assert found.outcomes[0].branches == outcomes


def test_the_rest_of_probability_is_an_outcome_in_which_nothing_happens() -> None:
    with pytest.warns(HddlWarning, match=r"sum to 0.8; with the rest nothing happens"):
        block = grasp("(probabilistic 0.8 (held ?b))").outcomes[0]
    *_, rest = block.branches
    assert (rest.effects, rest.costs) == ((), ())
    assert rest.probability == Arithmetic("-", (number("1"), number("0.8")))


@pytest.mark.parametrize(
    ("probabilities", "count"),
    [
        (("(p-slip ?b)", "(- 1 (p-slip ?b))"), 2),
        (("(* 0.5 (p-slip ?b))", "(- 1 (* (p-slip ?b) 0.5))"), 2),
        (("(p-slip ?c)", "(- 1 (p-slip ?b))"), 3),
        (("(* (p-slip ?c) (p-slip ?b))", "(- 1 (* (p-slip ?c) (p-slip ?b)))"), 2),
        (("(p-slip ?b)", "0.25"), 3),
    ],
)
def test_there_is_a_rest_unless_the_sum_is_1_whatever_the_functions_are(
    probabilities: tuple[str, str], count: int
) -> None:
    first, second = probabilities
    (block,) = grasp(f"(forall (?c - block) (probabilistic {first} (held ?b) {second} ()))").outcomes
    assert len(block.branches) == count


def test_blocks_under_when_and_forall() -> None:
    found = grasp(
        "(forall (?c - block) (when (wet ?c) (probabilistic 0.5 (when (icy) (held ?c)) 0.5 (increase (total-cost) 1))))"
    )
    (block,) = found.outcomes
    wet, icy, c = Atom("wet", ("?c",)), Atom("icy"), Parameter("?c", ("block",))
    assert (block.condition, block.parameters) == (wet, (c,))
    assert block.outcomes[0].effects == (Effect(Atom("held", ("?c",)), condition=icy),)
    assert found.all_effects == (Effect(Atom("held", ("?c",)), True, And((wet, icy)), (c,)),)
    (cost,) = found.all_costs
    assert (cost.condition, cost.parameters) == (wet, (c,))


def test_a_block_without_facts_is_a_cost() -> None:
    found = grasp("(and (probabilistic 0.5 (increase (total-cost) 1) 0.5 ()) (held ?b))")
    assert (found.outcomes, len(found.costs)) == ((), 1)


def test_an_uncertain_cost_inside_of_an_outcome() -> None:
    found = grasp("(probabilistic 0.5 (and (held ?b) (probabilistic 0.5 (increase (total-cost) 2) 0.5 ())) 0.5 ())")
    assert found.outcomes[0].outcomes[0].costs == (
        CostBlock(((number("0.5"), number("2")), (number("0.5"), number("0")))),
    )


def test_costs_of_outcomes_alone_are_costs() -> None:
    assert not read("(probabilistic 0.5 (and (held ?b) (increase (total-cost) 1)) 0.5 ())").domain.has_unit_costs
    assert read("(probabilistic 0.5 (held ?b) 0.5 ())").domain.has_unit_costs


@pytest.mark.parametrize(
    ("effect", "message"),
    [
        ("(probabilistic 0.6 (held ?b) 0.5 ())", "the probabilities of this block sum to 1.1, more than 1"),
        ("(probabilistic -0.1 (held ?b))", "a probability must not be negative, found -0.1"),
        ("(probabilistic 0.5 (held ?b) 0.5)", "expected pairs of a probability and an effect"),
        ("(probabilistic 0.5 (held ?b) 0.5 broken)", "expected an effect in parentheses, found 'broken'"),
        ("(probabilistic 0.5 (hald ?b) 0.5 ())", "unknown predicate 'hald'; did you mean 'held'?"),
        ("(probabilistic 0.5 (held ?b) 0.5 (increase (total-cost) -1))", "a cost must not be negative, found -1"),
        ("(probabilistic (slip ?b) (held ?b))", "unknown function 'slip'"),
        ("(probabilistic 0.5 (held ?c) 0.5 ())", "unknown variable '?c'"),
    ],
)
def test_outcomes_that_are_wrong(effect: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        read(effect)
    assert message in caught.value.message
    assert caught.value.place is not None
    assert caught.value.place.line == 3


@pytest.mark.parametrize(
    ("effect", "message"),
    [
        ("(probabilistic 0.5 (probabilistic 0.5 (broken)) 0.5 ())", "products of the probabilities in one block"),
        ("(oneof (broken) ())", "'probabilistic' states outcomes"),
        ("(probabilistic 0.5 (and (held ?b) (assign (p-slip ?b) 1)) 0.5 ())", "numeric effects ('assign')"),
        ("(probabilistic 0.5 (icy) 0.5 ())", "this effect changes a fact of 'icy'"),
        ("(when (icy) (probabilistic 0.5 (broken) 0.5 ()))", "these outcomes depend on a fact of 'icy'"),
        ("(probabilistic 0.5 (when (icy) (broken)) 0.5 ())", "this effect depends on a fact of 'icy'"),
    ],
)
@pytest.mark.filterwarnings("ignore:.*with the rest")
def test_outcomes_that_are_not_supported(effect: str, message: str) -> None:
    with pytest.raises(UnsupportedError) as caught:
        read(effect, "(probabilistic 0.5 (icy) 0.5 ())")
    assert message in caught.value.message
    assert caught.value.place is not None
    assert caught.value.place.line == 3


def test_conditions_of_costs_of_outcomes_may_read_hidden_facts() -> None:
    effect = "(probabilistic 0.5 (and (held ?b) (when (icy) (increase (total-cost) 1))) 0.5 ())"
    (outcome, _) = read(effect, "(probabilistic 0.5 (icy) 0.5 ())").domain.actions["grasp"].outcomes[0].outcomes
    assert outcome.costs[0].condition == Atom("icy")


def test_text_that_is_written_is_read_again() -> None:
    problem = read(
        """(and (increase (total-cost) 1) (wet ?b)
      (probabilistic (p-slip ?b) (and (increase (total-cost) 2) (when (icy) (broken)))
                     (- 1 (p-slip ?b)) (and (held ?b) (probabilistic 0.5 (increase (total-cost) 1) 0.5 ())))
      (forall (?c - block) (when (held ?c) (probabilistic 0.5 (forall (?e - block) (wet ?e)) 0.5 (not (wet ?c))))))"""
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        again = read_hddl_text(*statehtn.write_hddl(problem))
    assert again == problem
    assert again.domain.actions == problem.domain.actions
    assert len(again.domain.actions["grasp"].outcomes) == 2


def test_an_effect_that_may_come_makes_a_goal_possible() -> None:
    text = PROBLEM.replace("(:init", "(:goal (held a)) (:init")
    domain = """(define (domain d) (:types block)
  (:predicates (held ?b - block)) (:functions (p-slip ?b - block) - number)
  (:action grasp :parameters (?b - block) :effect (probabilistic 0.5 (held ?b) 0.5 ())))"""
    with warnings.catch_warnings():
        warnings.simplefilter("error", HddlWarning)
        read_hddl_text(domain, text)


def test_an_action_without_outcomes_has_its_effects_alone() -> None:
    found = grasp("(and (held ?b) (increase (total-cost) 2))")
    assert (found.all_effects, found.all_costs) == (found.effects, found.costs)
    assert found.precondition == TRUE
