"""Five traps of the search for policies, each as a small problem on which the obvious way is wrong.

What the obvious way would answer is worked out, too, so that the right answer can be seen to need the remedy.
"""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

import statehtn
from statehtn import PolicyResult, Problem, Status
from tests.explicit_graph import explicit_graph
from tests.explicit_memory import best_policy_with_memory
from tests.explicit_policies import best_policy

HALVES = "(probabilistic 0.5 {} 0.5 {})"


def problem(
    tasks: str, methods: str, actions: dict[str, str], first: str, facts: str = "", ordered: bool = False
) -> Problem:
    """A problem without objects: names of tasks, methods, effects of actions by name (precondition first), facts."""
    names = sorted({word.strip("()") for word in facts.split()} | {"p", "q", "stuck"})
    lines = [f"(:task {name} :parameters ())" for name in tasks.split()]
    for number, method in enumerate(filter(None, map(str.strip, methods.splitlines()))):
        task, _, rest = method.partition(" -> ")
        condition, _, steps = rest.rpartition("? ")
        lines.append(
            f"(:method m{number} :parameters () :task ({task}) {f':precondition {condition}' if condition else ''} "
            f":ordered-subtasks (and {' '.join(f'({step})' for step in steps.split())}))"
        )
    for name, text in actions.items():
        condition, _, effects = text.rpartition("? ")
        lines.append(f"(:action {name} :parameters () :precondition {condition or '()'} :effect (and {effects}))")
    domain = "\n".join(
        [
            "(define (domain trap)",
            f"(:predicates {' '.join(f'({name})' for name in names)})",
            "(:functions (total-cost) - number)",
            *lines,
            ")",
        ]
    )
    kind = "ordered-subtasks" if ordered else "subtasks"
    steps = " ".join(f"({name})" for name in first.split())
    text = f"(define (problem p) (:domain trap) (:htn :parameters () :{kind} (and {steps})) (:init {facts}))"
    return statehtn.read_hddl_text(domain, text)


def cost(amount: str) -> str:
    return f"(increase (total-cost) {amount})"


def policy(asked: Problem, objective: str, **options: float) -> PolicyResult:
    return statehtn.policy(asked, objective=objective, precision=1e-10, **options)


# ---- 1. branching: what task is decomposed first is a decision

COSTS_ELSEWHERE = problem(
    "first second",
    """first -> c1
    first -> c2
    second -> sure
    second -> bold""",
    {
        "c1": HALVES.format(cost("0"), cost("6")),
        "c2": cost("20"),
        "sure": cost("5"),
        "bold": HALVES.format(cost("0"), cost("9")),
    },
    "first second",
)
FACTS_ELSEWHERE = problem(
    "look act",
    """look -> see
    act -> left
    act -> right""",
    {"see": HALVES.format("(p)", "(q)"), "left": "(p)? " + cost("1"), "right": "(q)? " + cost("1")},
    "look act",
)


def test_the_choice_of_a_method_waits_for_a_cost_elsewhere() -> None:
    early = explicit_graph(COSTS_ELSEWHERE, decomposes_first=True)
    assert best_policy_with_memory(early, "deadline 8").value == Fraction(1, 2)
    result = policy(COSTS_ELSEWHERE, "deadline 8")
    assert result.status is Status.OPTIMAL
    assert result.value == pytest.approx(0.25, rel=1e-9)


def test_the_choice_of_a_method_waits_for_an_outcome_elsewhere() -> None:
    early = explicit_graph(FACTS_ELSEWHERE, decomposes_first=True)
    assert best_policy(early, "success").value == Fraction(1, 2)
    assert best_policy(early, "neutral").value is None
    assert policy(FACTS_ELSEWHERE, "success").value == pytest.approx(1, rel=1e-9)
    assert policy(FACTS_ELSEWHERE, "neutral").value == pytest.approx(1, rel=1e-9)


# ---- 2. loops that cost nothing: values from below stay below there

FREE_LOOP = problem(
    "again other",
    """again -> other
    other -> again
    other -> (p)? again
    again -> work
    other -> dear""",
    {"work": HALVES.format(f"(and (p) {cost('3')})", cost("5")), "dear": cost("7")},
    "again",
)
NO_WAY_OUT = problem("again other", "again -> other\nother -> again", {"work": "(p)"}, "again")


@pytest.mark.parametrize(("objective", "value"), [("neutral", 4.0), ("success", 1.0), ("overrun 3", 1.0)])
def test_a_loop_that_costs_nothing_is_worth_its_best_way_out(objective: str, value: float) -> None:
    assert policy(FREE_LOOP, objective).value == pytest.approx(value, rel=1e-9)


@pytest.mark.parametrize("sign", [1, -1])
def test_exponential_agents_in_a_loop_that_costs_nothing(sign: int) -> None:
    expected = math.log((math.exp(sign * 1.5) + math.exp(sign * 2.5)) / 2) / (sign * 0.5)
    result = policy(FREE_LOOP, "averse 0.5" if sign > 0 else "seeking 0.5")
    assert result.value == pytest.approx(expected, rel=1e-9)


def test_a_loop_without_a_way_out_has_failed() -> None:
    result = policy(NO_WAY_OUT, "neutral")
    assert (result.status, result.policy) == (Status.UNSOLVABLE, None)
    assert policy(NO_WAY_OUT, "success").value == 0
    assert policy(NO_WAY_OUT, "neutral", failure_cost=5).value == pytest.approx(5, rel=1e-9)


# ---- 3. retry loops under aversion: infinite though the mean is finite

RETRY = """try -> (p)? carry
    try -> (not (p))? grip try"""
GRIP = {"grip": HALVES.format("(p)", "()") + cost("1"), "carry": cost("3")}
ONLY_RETRY = problem("try", RETRY, GRIP, "try")
OR_PAY = problem("try", f"{RETRY}\ntry -> pay", {**GRIP, "pay": cost("20")}, "try")


def test_the_closed_form_of_a_retry_loop() -> None:
    assert policy(ONLY_RETRY, "neutral").value == pytest.approx(5, rel=1e-9)
    half = math.exp(0.3) / 2
    assert policy(ONLY_RETRY, "averse 0.3").value == pytest.approx(math.log(half / (1 - half)) / 0.3 + 3, rel=1e-9)


def test_an_averse_agent_never_retries_for_ever() -> None:
    objective = "averse 0.7"
    result = policy(ONLY_RETRY, objective)
    assert (result.status, result.policy, result.value) == (Status.UNSOLVABLE, None, None)
    assert "0.7" in result.reason
    assert policy(OR_PAY, objective).value == pytest.approx(20, rel=1e-9)
    assert policy(OR_PAY, "neutral").value == pytest.approx(5, rel=1e-9)


FIERCE = problem("try", f"{RETRY}\ntry -> (not (p))? hurt try", {**GRIP, "hurt": cost("9")}, "try")


@pytest.mark.parametrize("alpha", [math.log(2) - 4e-10, math.log(2), math.log(2) + 4e-10])
@pytest.mark.parametrize("asked", [ONLY_RETRY, FIERCE])
def test_a_spectral_radius_of_nearly_1_is_not_decided(asked: Problem, alpha: float) -> None:
    result = policy(asked, f"averse {alpha!r}")
    assert (result.status, result.policy) == (Status.GAVE_UP, None)
    assert "too close to call" in result.reason
    assert policy(OR_PAY, f"averse {alpha!r}").value == pytest.approx(20, rel=1e-9)


@pytest.mark.parametrize("asked", [ONLY_RETRY, FIERCE])
def test_a_spectral_radius_that_is_not_so_near_is_decided(asked: Problem) -> None:
    assert policy(asked, f"averse {math.log(2) + 4e-9!r}").status is Status.UNSOLVABLE
    alpha = math.log(2) - 4e-6
    half = math.exp(alpha) / 2
    expected = math.log(half / (1 - half)) / alpha + 3
    assert policy(asked, f"averse {alpha!r}").value == pytest.approx(expected, rel=1e-6)


# ---- 4. not done with probability 1: never read off the value

GAMBLE = {
    "gamble": HALVES.format("(p)", "(stuck)") + cost("1"),
    "finish": "(p)? ",
    "work": cost("9"),
    "wait": cost("1"),
}
ONLY_GAMBLE = problem("get", "get -> gamble finish", GAMBLE, "get")
OR_WORK = problem("get", "get -> gamble finish\nget -> work", GAMBLE, "get")
OR_WAIT = problem("get on", "get -> gamble on\non -> (p)? finish\non -> wait on\nget -> work", GAMBLE, "get")


def test_a_seeking_agent_does_not_count_on_half_a_chance() -> None:
    read_off = -math.log(math.exp(-0.5) / 2) / 0.5
    assert read_off == pytest.approx(2.39, abs=0.005)  # finite, and below the value of every policy that is done
    result = policy(ONLY_GAMBLE, "seeking 0.5")
    assert (result.status, result.policy) == (Status.UNSOLVABLE, None)
    assert result.most_success == pytest.approx(0.5, rel=1e-9)
    for asked in (OR_WORK, OR_WAIT):
        assert policy(asked, "seeking 0.5").value == pytest.approx(9, rel=1e-9)
        assert policy(asked, "neutral").value == pytest.approx(9, rel=1e-9)


def test_a_loop_in_a_dead_end_whose_cost_rises_for_ever_ends_the_search() -> None:
    only = problem("get on", "get -> gamble on\non -> (p)? finish\non -> wait on", GAMBLE, "get")
    for objective in ("neutral", "seeking 0.5", "averse 0.5", "deadline 4"):
        assert policy(only, objective).status is Status.UNSOLVABLE
    result = policy(only, "success")
    assert result.value == pytest.approx(0.5)
    assert result.expected_cost == pytest.approx(1)


# ---- 5. determinisation and success: the likeliest trajectory is not the policy


def test_trying_again_succeeds_in_the_end() -> None:
    """Every trajectory of a retry loop has a probability of at most 1/2, and being done has 1."""
    result = policy(ONLY_RETRY, "success")
    assert result.value == pytest.approx(1, rel=1e-9)
    assert result.expected_cost == pytest.approx(5, rel=1e-9)
