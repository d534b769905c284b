"""What Python and notebooks show of results: some words, not all that is inside; what can be compared and hashed."""

from __future__ import annotations

import random

import pytest

import statehtn
from statehtn import CostDistribution, Decomposition, Plan, Step
from statehtn.found_plan import PricedSteps
from statehtn.model.cost.sum import CostSum
from tests.test_minimal import DOMAIN, PROBLEM

LONG = """
(define (domain long)
  (:functions (total-cost) - number)
  (:task all :parameters ())
  (:method do :parameters () :task (all) :ordered-subtasks (and {}))
  (:action work :parameters () :effect (increase (total-cost) 1)))
""".format(" ".join(["(work)"] * 300))
SHORTER = 300  # characters


@pytest.fixture(scope="module")
def many() -> dict[str, object]:
    generator = random.Random(1)
    problem = statehtn.read_hddl_text(
        LONG, "(define (problem p) (:domain long) (:htn :ordered-subtasks (and (all))) (:init))"
    )
    law = CostDistribution.from_samples([generator.random() for _ in range(200)])
    problem = statehtn.with_cost(problem, "work", law)
    result = statehtn.plan(problem)
    assert result.plan is not None
    wrong = Plan((Step("no-such-action"),) * 200, result.plan.roots)
    return {
        "problem": problem,
        "law of samples": law,
        "sum": CostSum((law,) * 100),
        "total": result.plan.cost_distribution(),
        "result": result,
        "steps": result.steps,
        "step": result.steps[0],
        "plan": result.plan,
        "root": result.plan.roots[0],
        "tree": result.plan.decomposition,
        "valid": statehtn.validate(problem, result.plan),
        "invalid": statehtn.validate(problem, wrong),
        "top": statehtn.top_plans(problem, 1),
        "ranked": statehtn.top_plans(problem, 1)[0],
        "frontier": statehtn.frontier(problem, "deviation"),
        "map": statehtn.attitude_map(problem, -1, 1, eps=1.0),
        "comparison": statehtn.compare_attitudes(problem),
    }


def test_everything_is_shown_in_short(many: dict[str, object]) -> None:
    lengths = {name: len(repr(value)) for name, value in many.items()}
    assert {name: length for name, length in lengths.items() if length > SHORTER} == {}
    assert "at 0x" not in " ".join(map(repr, many.values()))


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("result", "<result for neutral: optimal, 300 steps, certainty equivalent "),
        ("steps", "<300 priced steps: (work) (work)"),
        ("plan", "<plan of 300 steps: (work) (work) (work) (work) (work) ...>"),
        ("root", "<decomposition of (all) by do>"),
        ("law of samples", "<SampledCost: 200 outcomes from "),
        ("sum", "<CostSum: 100 independent parts, from "),
        ("valid", "<validation: valid, 300 steps, expected cost "),
        ("invalid", "<validation: invalid: "),
        ("top", "<1 plan for neutral: optimal, 1 proven>"),
        ("ranked", "<plan 1: 300 steps, certainty equivalent "),
        ("comparison", "<comparison of averse 1, neutral, seeking 1>"),
    ],
)
def test_in_words(many: dict[str, object], name: str, words: str) -> None:
    assert repr(many[name]).startswith(words)


def test_a_validation_says_whether_a_plan_is_valid(many: dict[str, object]) -> None:
    assert str(many["valid"]) == "valid"
    text = str(many["invalid"])
    assert text.startswith("invalid:\n- ")
    assert "there is no action 'no-such-action'" in text


@pytest.mark.parametrize("name", ["law of samples", "total", "steps", "valid", "invalid", "result", "top", "tree"])
def test_notebooks_show_tables(many: dict[str, object], name: str) -> None:
    html = many[name]._repr_html_()  # type: ignore[attr-defined]
    assert html.startswith("<")
    assert "<table" in html or name in ("tree", "invalid")


def test_a_law_of_few_outcomes_lists_them() -> None:
    html = CostDistribution.of([(0.8, 2), (0.2, 9)])._repr_html_()
    for words in ("standard deviation", ">3.4<", ">0.8<", ">9<"):
        assert words in html


def test_notebooks_show_the_ends_of_very_long_plans(many: dict[str, object]) -> None:
    steps = many["steps"]
    assert isinstance(steps, PricedSteps)
    html = PricedSteps([*steps] * 10)._repr_html_()
    assert "... 2000 more ..." in html
    assert html.count("<tr>") < 1100


def test_problems_can_be_kept_in_sets() -> None:
    problem, same = statehtn.read_hddl_text(DOMAIN, PROBLEM), statehtn.read_hddl_text(DOMAIN, PROBLEM)
    other = statehtn.with_cost(problem, "take-car", lambda: 3)
    assert problem == same
    assert hash(problem) == hash(same)
    assert len({problem, same, other}) == 2
    assert {problem: "kept"}[same] == "kept"


def deep(bottom: str) -> Decomposition:
    found = Decomposition("task", (bottom,), "method", (0,))
    for _ in range(5000):
        found = Decomposition("task", (), "method", (found,))
    return found


def test_deep_decompositions_are_compared_without_recursion() -> None:
    assert deep("a") == deep("a")
    assert deep("a") != deep("b")
    assert hash(deep("a")) == hash(deep("a"))
    assert Plan((Step("a"),), (deep("a"),)) == Plan((Step("a"),), (deep("a"),))
    inner, outer = Decomposition("t", (), "m"), Decomposition("t", (), "m", (0,))
    assert inner != outer
    assert Decomposition("t", (), "m", (inner, outer)) != Decomposition("t", (), "m", (outer, inner))
    assert inner != "t"
