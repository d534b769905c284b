"""What may come of actions with several outcomes: by the lifted model, built from Python objects, and as costs."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

import statehtn
from statehtn import CostDistribution, Outcome, ProblemBuilder
from statehtn.errors import InputError, UnsupportedError, UsageError
from statehtn.hddl.reader import read_hddl_text
from statehtn.model import Decomposition, Plan, Problem, Step
from statehtn.model.plan_outcome import PlanOutcome
from statehtn.model.status import Status
from statehtn.semantics.outcomes import Transitions
from statehtn.semantics.world import World
from statehtn.validation import validate_trajectory, validation

DOMAIN = """(define (domain d) (:types block)
  (:predicates (held ?b - block) (wet ?b - block) (broken) (icy) (seen ?b - block))
  (:functions (p-slip ?b - block) - number)
  (:task get :parameters (?b - block))
  (:method m-try :parameters (?b - block) :task (get ?b) :ordered-subtasks (and (grasp ?b) (get ?b)))
  (:method m-done :parameters (?b - block) :task (get ?b) :precondition (held ?b) :subtasks ())
  (:action grasp :parameters (?b - block) :precondition (not (broken)) :effect EFFECT))"""
PROBLEM = """(define (problem p) (:domain d) (:objects a b - block)
  (:htn :subtasks (get a)) (:init INIT (= (p-slip a) 0.25) (= (p-slip b) 0.5)))"""
GRASP = Step("grasp", ("a",))
HELD, WET, BROKEN = ("held", "a"), ("wet", "a"), ("broken",)
NOTHING: frozenset[tuple[str, ...]] = frozenset()


def read(effect: str, init: str = "") -> Problem:
    """Return a problem whose action has this effect."""
    return read_hddl_text(DOMAIN.replace("EFFECT", effect), PROBLEM.replace("INIT", init))


def outcomes(
    effect: str, facts: frozenset[tuple[str, ...]] = NOTHING
) -> dict[tuple[frozenset[tuple[str, ...]], frozenset[tuple[str, ...]]], tuple[Fraction, str]]:
    """Return what may come of grasping block a in a state: probability and law by what becomes true and false."""
    found = Transitions(World(read(effect))).outcomes(GRASP, facts)
    assert found is not None
    return {(one.added, one.deleted): (one.probability, str(one.law)) for one in found}


def test_facts_and_costs_of_a_branch_come_together() -> None:
    found = outcomes("(and (increase (total-cost) 1) (probabilistic (p-slip ?b) () (- 1 (p-slip ?b)) (held ?b)))")
    assert found == {
        (NOTHING, NOTHING): (Fraction(1, 4), "1"),
        (frozenset({HELD}), NOTHING): (Fraction(3, 4), "1"),
    }


def test_blocks_are_independent_and_deletes_come_before_adds() -> None:
    found = outcomes(
        """(and (not (wet ?b)) (probabilistic 0.5 (wet ?b) 0.5 (held ?b))
        (probabilistic 0.2 (and (not (held ?b)) (increase (total-cost) 3)) 0.8 ()))""",
        frozenset({WET, HELD}),
    )
    assert found == {
        (NOTHING, frozenset({HELD})): (Fraction(1, 10), "3"),
        (NOTHING, NOTHING): (Fraction(2, 5), "0"),
        (NOTHING, frozenset({WET})): (Fraction(1, 2), "0 w.p. 0.8, 3 w.p. 0.2"),
    }


def test_outcomes_with_the_same_facts_are_one_whose_law_is_the_mixture() -> None:
    found = outcomes(
        "(probabilistic 0.2 (and (held ?b) (increase (total-cost) 1)) 0.3 (and (held ?b) (increase (total-cost) 2)) "
        "0.5 (broken))"
    )
    assert found[frozenset({HELD}), NOTHING] == (Fraction(1, 2), "1 w.p. 0.4, 2 w.p. 0.6")


def test_blocks_under_conditions_and_for_all_objects() -> None:
    effect = (
        "(forall (?c - block) (when (wet ?c) (probabilistic 0.5 (and (held ?c) (increase (total-cost) 1)) 0.5 ())))"
    )
    assert outcomes(effect) == {(NOTHING, NOTHING): (Fraction(1), "0")}
    found = outcomes(effect, frozenset({WET, ("wet", "b")}))
    assert {key[0]: value for key, value in found.items()} == {
        NOTHING: (Fraction(1, 4), "0"),
        frozenset({HELD}): (Fraction(1, 4), "1"),
        frozenset({("held", "b")}): (Fraction(1, 4), "1"),
        frozenset({HELD, ("held", "b")}): (Fraction(1, 4), "2"),
    }


def test_conditions_inside_of_a_branch_are_read_before_the_action() -> None:
    effect = "(probabilistic 0.5 (and (icy) (when (icy) (and (broken) (increase (total-cost) 2)))) 0.5 ())"
    assert outcomes(effect)[frozenset({("icy",)}), NOTHING] == (Fraction(1, 2), "0")
    assert outcomes(effect, frozenset({("icy",)}))[frozenset({BROKEN}), NOTHING] == (Fraction(1, 2), "2")


def test_branches_of_probability_0_never_come() -> None:
    assert list(outcomes("(probabilistic 0 (broken) 1 (held ?b))")) == [(frozenset({HELD}), NOTHING)]


def test_steps_that_cannot_be_executed() -> None:
    transitions = Transitions(World(read("(probabilistic 0.5 (held ?b) 0.5 ())")))
    assert transitions.outcomes(GRASP, frozenset({BROKEN})) is None
    assert "(broken)" in (transitions.why_not(GRASP, frozenset({BROKEN})) or "")
    assert transitions.outcomes(Step("jump"), NOTHING) is None
    assert transitions.why_not(GRASP, NOTHING) is None


def test_facts_that_are_not_seen_tell_no_outcomes_apart() -> None:
    problem = read(
        "(and (probabilistic 0.5 (held ?b) 0.5 ()) (forall (?c - block) (probabilistic 0.5 (wet ?c) 0.5 ())))"
    )
    assert len(Transitions(World(problem)).outcomes(GRASP, NOTHING) or ()) == 8
    assert len(Transitions(World(problem), frozenset({HELD})).outcomes(GRASP, NOTHING) or ()) == 2


@pytest.mark.parametrize(
    ("effect", "message"),
    [
        ("(probabilistic (- (p-slip ?b) 0.5) (held ?b) 0.5 ())", "a probability must not be negative, found -0.25"),
        ("(probabilistic (* 5 (p-slip ?b)) (held ?b))", "sum to 1.25, more than 1"),
        ("(probabilistic (p-slip ?b) (held ?b) 0.9 ())", "sum to 1.15, more than 1"),
    ],
)
def test_probabilities_that_are_none_name_action_and_place(effect: str, message: str) -> None:
    problem = read(effect)
    with pytest.raises(InputError) as caught:
        Transitions(World(problem)).outcomes(GRASP, NOTHING)
    assert message in caught.value.message
    assert "the outcomes of (grasp a)" in caught.value.message
    assert caught.value.place is not None
    assert caught.value.place.line == 7


def tried(times: int) -> Plan:
    """Return so many tries, of which the last one succeeds, with their decomposition."""
    tree = Decomposition("get", ("a",), "m-done")
    for step in reversed(range(times)):
        tree = Decomposition("get", ("a",), "m-try", (step, tree))
    return Plan((GRASP,) * times, (tree,))


RETRY = "(and (increase (total-cost) 1) (probabilistic 0.5 (held ?b) 0.5 (increase (total-cost) 2)))"
FAILED, SUCCEEDED = (NOTHING, NOTHING), (frozenset({HELD}), NOTHING)


def test_a_run_in_which_chance_has_chosen_is_checked() -> None:
    problem = read(RETRY)
    found = validate_trajectory(problem, tried(2), [FAILED, SUCCEEDED])
    assert found.valid, found
    assert [str(law) for law in found.costs] == ["3", "1"]
    wrong = validate_trajectory(problem, tried(2), [FAILED, FAILED])
    assert "its precondition does not hold" in str(wrong)
    none = validate_trajectory(problem, tried(1), [(frozenset({BROKEN}), NOTHING)])
    assert "step 1 (grasp a): what came of it is none of its outcomes" in none.reasons
    with pytest.raises(UsageError, match="needs what came of each, found 1"):
        validate_trajectory(problem, tried(2), [FAILED])


def test_what_is_not_seen_need_not_be_told() -> None:
    problem = read(f"(and {RETRY} (probabilistic 0.5 (wet ?b) 0.5 ()))")
    assert validate_trajectory(problem, tried(1), [SUCCEEDED], frozenset({HELD})).valid
    assert validate_trajectory(problem, tried(1), [(frozenset({HELD, WET}), NOTHING)]).valid
    assert not validate_trajectory(problem, tried(1), [FAILED], frozenset({HELD})).valid


def test_plans_that_do_not_say_what_came_count_on_the_likeliest() -> None:
    problem = read(RETRY)
    found = statehtn.validate(problem, tried(1))
    assert found.valid
    assert found.outcomes is not None
    assert [(outcome.probability, set(outcome.added)) for outcome in found.outcomes] == [(Fraction(1, 2), {HELD})]
    assert (found.probability, found.to_dict()["probability"]) == (0.5, 0.5)
    assert statehtn.validate(problem, tried(2)).probability == 0.25
    counting = replace(tried(1), outcomes=(PlanOutcome(Fraction(1, 2), frozenset({HELD})),))
    assert statehtn.validate(problem, counting).valid
    too_likely = replace(tried(1), outcomes=(PlanOutcome(Fraction(3, 4), frozenset({HELD})),))
    assert "step 1 (grasp a): it is said to lead there with probability 0.75, and does with 0.5" in str(
        statehtn.validate(problem, too_likely)
    )


def test_what_methods_ask_for_may_take_another_run(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = read("(probabilistic 0.7 (wet ?b) 0.3 (held ?b))")
    found = statehtn.validate(problem, tried(1))
    assert (found.valid, found.probability) == (True, 0.3)  # though it likelier becomes wet
    assert statehtn.validate(problem, [GRASP]).probability == 0.3
    monkeypatch.setattr(validation, "MOST_RUNS", 1)
    undecided = statehtn.validate(problem, tried(1))
    assert (undecided.valid, undecided.stopped) == (False, Status.GAVE_UP)
    assert "it is a plan in none of the 1 runs of it that are looked at" in str(undecided)


def test_chance_alone_has_no_plan() -> None:
    problem = read(RETRY)
    with pytest.raises(UnsupportedError, match="action 'grasp' changes facts by chance") as caught:
        statehtn.plan(problem)
    assert caught.value.place is not None
    with pytest.raises(UnsupportedError, match="action 'grasp' changes facts by chance"):
        statehtn.top_plans(problem, 2)


class TestBuilder:
    """The same from Python objects."""

    def build(self) -> ProblemBuilder:
        """Return a builder with types and predicates."""
        builder = ProblemBuilder("p", "d")
        block = builder.type("block")
        block.objects("a", "b")
        builder.predicate("held", block.variable("b"))
        builder.predicate("wet", block.variable("b"))
        builder.predicate("broken")
        builder.function("slip", block.variable("b"))
        return builder

    def test_outcomes_side_by_side_are_a_block(self) -> None:
        builder = self.build()
        held, broken, slip = builder.predicates["held"], builder.predicates["broken"], builder.functions["slip"]
        b, c = builder.types["block"].variables("b", "c")
        builder.action(
            "grasp",
            [b],
            cost=1,
            outcomes=[
                Outcome(slip(b), cost=[2, CostDistribution.of([(0.5, 1), (0.5, 3)])]),
                Outcome(1 - slip(b), [held(b), statehtn.when(broken(), ~broken())]),
                [Outcome(0.5, held(b)), Outcome(0.5)],
                statehtn.when(broken(), Outcome(0.1, ~broken()), Outcome(0.9)),
                statehtn.forall([c], Outcome(0.5, ~held(c)), Outcome(0.5)),
            ],
        )
        builder.set_values({slip("a"): 0.25, slip("b"): 0.5})
        builder.set_network([builder.tasks["grasp"]("a")])
        problem = builder.build()
        text = """(and (increase (total-cost) 1)
          (probabilistic (slip ?b) (and (increase (total-cost) 2)
                                        (probabilistic 0.5 (increase (total-cost) 1) 0.5 (increase (total-cost) 3)))
                         (- 1 (slip ?b)) (and (held ?b) (when (broken) (not (broken)))))
          (probabilistic 0.5 (held ?b) 0.5 ())
          (when (broken) (probabilistic 0.1 (not (broken)) 0.9 ()))
          (forall (?c - block) (probabilistic 0.5 (not (held ?c)) 0.5 ())))"""
        domain = f"""(define (domain d) (:types block)
          (:predicates (held ?b - block) (wet ?b - block) (broken)) (:functions (slip ?b - block) - number)
          (:action grasp :parameters (?b - block) :effect {text}))"""
        read = read_hddl_text(domain, statehtn.write_hddl(problem)[1])
        assert read.domain.actions == problem.domain.actions
        assert read_hddl_text(*statehtn.write_hddl(problem)) == problem

    def test_what_is_wrong(self) -> None:
        builder = self.build()
        held = builder.predicates["held"]
        (b,) = builder.types["block"].variables("b")
        with pytest.raises(UsageError, match=r"must sum to 1, found 0.5; Outcome\(0.5\) is one in which nothing"):
            builder.action("grasp", [b], outcomes=Outcome(0.5, held(b)))
        with pytest.raises(UsageError, match="must sum to 1, found 1.5"):
            builder.action("grasp", [b], outcomes=[Outcome(0.5, held(b)), Outcome(1)])
        with pytest.raises(UsageError, match="a probability must not be negative"):
            Outcome(-0.5, held(b))
        with pytest.raises(UsageError, match="no outcome of action 'grasp' changes a fact"):
            builder.action("grasp", [b], outcomes=[Outcome(0.5, cost=1), Outcome(0.5)])
        with pytest.raises(UsageError, match="an outcome is Outcome"):
            builder.action("grasp", [b], outcomes=[(0.5, held(b)), (0.5, ())])

    def test_outcomes_must_not_change_or_read_hidden_facts(self) -> None:
        for hidden in ("broken", "icy"):
            builder = self.build()
            (b,) = builder.types["block"].variables("b")
            broken, icy = builder.predicates["broken"](), builder.predicate("icy")()
            part = statehtn.when(broken, Outcome(0.5, icy), Outcome(0.5))
            builder.set_network([builder.action("grasp", [b], outcomes=part)("a")])
            builder.initially_by_chance((0.5, broken if hidden == "broken" else icy), (0.5, ()))
            verb = "depends on" if hidden == "broken" else "changes"
            with pytest.raises(UnsupportedError, match=f"an effect of action 'grasp' {verb} a fact of '{hidden}'"):
                builder.build()

    def test_another_cost_replaces_those_of_outcomes(self) -> None:
        problem = read("(probabilistic 0.5 (and (held ?b) (increase (total-cost) 1)) 0.5 (increase (total-cost) 2))")
        other = statehtn.with_cost(problem, "grasp", 7)
        found = Transitions(World(other)).outcomes(GRASP, NOTHING)
        assert found is not None
        assert [str(one.law) for one in found] == ["7", "7"]
        found = Transitions(World(statehtn.with_cost(problem, "grasp", 7, when="(wet ?b)"))).outcomes(
            GRASP, frozenset({WET})
        )
        assert found is not None
        assert [str(one.law) for one in found] == ["8", "9"]
