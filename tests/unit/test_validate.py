"""The validator: a valid plan, and invalid plans of every kind."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from statehtn.display.validation import readable_validation
from statehtn.errors import InputError
from statehtn.model import (
    TRUE,
    Action,
    And,
    Atom,
    CostBlock,
    CostDistribution,
    Decomposition,
    Domain,
    Effect,
    Equals,
    Exists,
    Forall,
    Formula,
    FunctionTerm,
    Method,
    Not,
    Number,
    OfType,
    Or,
    Parameter,
    Plan,
    Problem,
    Signature,
    Step,
    Subtask,
    TaskNetwork,
    TypeHierarchy,
)
from statehtn.model.status import Status
from statehtn.risk import Neutral, utility_for
from statehtn.validation import Validation, validate


def variables(**types: str) -> tuple[Parameter, ...]:
    return tuple(Parameter(f"?{name}", (kind,)) for name, kind in types.items())


def network(*tasks: str, ordered: bool = True, constraints: Formula = TRUE) -> TaskNetwork:
    subtasks = tuple(Subtask(f"t{i}", name, tuple(terms)) for i, (name, *terms) in enumerate(map(str.split, tasks)))
    ordering = tuple((i, i + 1) for i in range(len(tasks) - 1)) if ordered else ()
    return TaskNetwork(subtasks, ordering, constraints)


def atom(text: str) -> Atom:
    name, *terms = text.split()
    return Atom(name, tuple(terms))


def adds(*atoms: str) -> tuple[Effect, ...]:
    return tuple(Effect(atom(text)) for text in atoms)


def deletes(*atoms: str) -> tuple[Effect, ...]:
    return tuple(Effect(atom(text), positive=False) for text in atoms)


def cost(value: int, condition: Formula = TRUE, parameters: tuple[Parameter, ...] = ()) -> CostBlock:
    return CostBlock(((Number(Fraction(1)), Number(Fraction(value))),), condition, parameters)


def named(*items: Any) -> dict[str, Any]:
    return {item.name: item for item in items}


ON_ROAD = variables(v="truck", x="place", y="place")
DELIVERY = Domain(
    "delivery",
    TypeHierarchy({"truck": ("object",), "place": ("object",), "city": ("place",)}),
    tasks=named(
        Signature("deliver", variables(v="truck", y="place")),
        Signature("go", variables(v="truck", y="place")),
    ),
    actions=named(
        Action(
            "drive",
            ON_ROAD,
            And((atom("at ?v ?x"), Or((atom("road ?x ?y"), atom("road ?y ?x"))), Not(Equals("?x", "?y")))),
            (*deletes("at ?v ?x"), *adds("at ?v ?y")),
            (cost(4), cost(3, atom("icy ?y"))),
        ),
        Action("load", variables(v="truck"), TRUE, adds("loaded ?v"), (cost(1),)),
        Action("drop", variables(v="truck"), atom("loaded ?v"), (*deletes("loaded ?v"), *adds("done"))),
    ),
    methods=named(
        Method("direct", ON_ROAD, "go", ("?v", "?y"), network("drive ?v ?x ?y"), atom("at ?v ?x")),
        Method(
            "via",
            variables(v="truck", x="place", z="city", y="place"),
            "go",
            ("?v", "?y"),
            network("drive ?v ?x ?z", "go ?v ?y", constraints=Not(Equals("?z", "?y"))),
            atom("at ?v ?x"),
        ),
        Method("stay", variables(v="truck", y="place"), "go", ("?v", "?y"), TaskNetwork(), atom("at ?v ?y")),
        Method(
            "by-truck",
            variables(v="truck", y="place"),
            "deliver",
            ("?v", "?y"),
            network("load ?v", "go ?v ?y", "drop ?v"),
        ),
    ),
)
PROBLEM = Problem(
    "p",
    DELIVERY,
    objects={"t1": "truck", "t2": "truck", "a": "place", "b": "city", "c": "city"},
    network=network("deliver t1 c"),
    initial_state=frozenset(
        {("at", "t1", "a"), ("at", "t2", "b"), ("road", "a", "b"), ("road", "c", "b"), ("icy", "c")}
    ),
    goal=And((atom("done"), atom("at t1 c"))),
)


def steps(*texts: str) -> tuple[Step, ...]:
    return tuple(Step(name, tuple(arguments)) for name, *arguments in map(str.split, texts))


def node(text: str, method: str, *children: int | Decomposition, bindings: str | None = None) -> Decomposition:
    task, *arguments = text.split()
    return Decomposition(
        task, tuple(arguments), method, children, None if bindings is None else tuple(bindings.split())
    )


def deliver(*children: int | Decomposition) -> tuple[Decomposition, ...]:
    return (node("deliver t1 c", "by-truck", *children),)


GO = node("go t1 c", "via", 1, node("go t1 c", "direct", 2))
PLAN = Plan(steps("load t1", "drive t1 a b", "drive t1 b c", "drop t1"), deliver(0, GO, 3))


def reasons(plan: Plan, problem: Problem = PROBLEM) -> str:
    validation = validate(problem, plan)
    assert not validation
    assert not validation.valid
    return "\n".join(validation.reasons)


def test_a_valid_plan_and_its_costs() -> None:
    validation = validate(PROBLEM, PLAN)
    assert validation
    assert validation.reasons == ()
    assert validation.costs == tuple(map(CostDistribution.certain, (1.0, 4.0, 7.0, 0.0)))
    assert validation.expected_cost == 12.0
    assert validation.risk_cost(Neutral()) == 12.0
    assert validation.risk_cost(utility_for("averse", 0.5)) == pytest.approx(12.0)


def test_bindings_are_checked_where_the_plan_tells_them() -> None:
    right = node("go t1 c", "via", 1, node("go t1 c", "direct", 2, bindings="t1 b c"), bindings="t1 a b c")
    assert validate(PROBLEM, replace(PLAN, roots=deliver(0, right, 3)))
    for bindings, reason in [
        ("t1 a b", "expected 4 arguments, found 3"),
        ("t1 b b c", "expected subtask (drive t1 b b), found (drive t1 a b)"),
        ("t2 a b c", "contradict the task's arguments"),
        ("t1 a t2 c", "'t2' is a truck, expected ?z - city"),
    ]:
        wrong = replace(GO, bindings=tuple(bindings.split()))
        assert reason in reasons(replace(PLAN, roots=deliver(0, wrong, 3)))


@pytest.mark.parametrize(
    ("texts", "reason"),
    [
        (
            ("load t1", "drive t1 a c", "drive t1 b c", "drop t1"),
            "step 2 (drive t1 a c): its precondition does not hold",
        ),
        (("load t1", "drive t1 a c", "drive t1 b c", "drop t1"), "(or (road a c) (road c a)) is false"),
        (("load t1", "drive t1 a b", "drive t1 a c", "drop t1"), "(at t1 a) is false"),
        (("load t1", "fly t1 a b", "drive t1 b c", "drop t1"), "step 2 (fly t1 a b): there is no action 'fly'"),
        (("load t1", "drive t1 a", "drive t1 b c", "drop t1"), "step 2 (drive t1 a): expected 3 arguments, found 2"),
        (("load t1", "drive t1 a x", "drive t1 b c", "drop t1"), "there is no object 'x'"),
        (("load t1", "drive t1 a t2", "drive t1 b c", "drop t1"), "'t2' is a truck, expected ?y - place"),
    ],
)
def test_a_plan_that_cannot_be_executed(texts: tuple[str, ...], reason: str) -> None:
    plan = replace(PLAN, steps=steps(*texts))
    assert reason in reasons(plan)
    assert len(validate(PROBLEM, plan).costs) == (2 if texts[2] == "drive t1 a c" else 1)


def test_the_goal_must_hold_in_the_end() -> None:
    goal = And((atom("done"), Not(atom("at t1 c")), atom("loaded t1")))
    text = reasons(PLAN, replace(PROBLEM, goal=goal))
    assert "the goal does not hold in the end: (not (at t1 c)) is false, (loaded t1) is false" in text


@pytest.mark.parametrize(
    ("roots", "reason"),
    [
        ((), "the initial network: expected 1 subtasks, found 0"),
        ((node("deliver t2 c", "by-truck", 0, GO, 3),), "expected subtask (deliver t1 c), found (deliver t2 c)"),
        ((0,), "the initial network: expected subtask (deliver t1 c), found (load t1)"),
        (deliver(0, GO), "method 'by-truck' of (deliver t1 c): expected 3 subtasks, found 2"),
        (deliver(3, GO, 0), "expected subtask (load t1), found (drop t1)"),
        (deliver(0, 1, 3), "expected subtask (go t1 c), found (drive t1 a b)"),
        (deliver(0, GO, 9), "for subtask (drop t1) there is no step 10; the plan has 4 steps"),
        (deliver(0, GO, -1), "for subtask (drop t1) there is no step 0"),
        (deliver(0, node("go t1 c", "direct", 2), 3), "step 2 (drive t1 a b): it is not part of the decomposition"),
        (deliver(0, node("go t1 c", "via", 2, node("go t1 c", "direct", 2)), 3), "it stands 2 times in"),
        (deliver(0, node("go t1 c", "teleport"), 3), "task (go t1 c): there is no method 'teleport'"),
        (deliver(0, node("go t1 c", "by-truck", 0, GO, 3), 3), "method 'by-truck' is for task 'deliver'"),
        (deliver(0, node("walk t1 c", "direct", 1), 3), "there is no compound task 'walk'"),
        (deliver(0, node("go t1", "direct", 1), 3), "task (go t1): expected 2 arguments, found 1"),
        (deliver(0, node("go c t1", "direct", 1), 3), "task (go c t1): 'c' is a city, expected ?v - truck"),
        (deliver(0, node("go t1 b", "direct", 1), 3), "expected subtask (go t1 c), found (go t1 b)"),
    ],
)
def test_a_wrong_decomposition(roots: tuple[int | Decomposition, ...], reason: str) -> None:
    assert reason in reasons(replace(PLAN, roots=roots))


def test_constraints_and_types_of_method_variables() -> None:
    there_and_back = ("load t1", "drive t1 a b", "drive t1 b c", "drive t1 c b", "drive t1 b c", "drop t1")
    inner = node("go t1 c", "via", 3, node("go t1 c", "direct", 4))
    through_c = node("go t1 c", "via", 1, node("go t1 c", "via", 2, inner))
    text = reasons(Plan(steps(*there_and_back), deliver(0, through_c, 5)))
    assert "method 'via' of (go t1 c): its constraints do not hold for ?v = t1, ?y = c, ?x = b, ?z = c" in text
    place = {**PROBLEM.objects, "b": "place"}
    assert "?z is 'b', which is not of the type of ?z - city" in reasons(PLAN, replace(PROBLEM, objects=place))


def test_the_order_of_a_method_s_subtasks() -> None:
    plan = Plan(steps("drive t1 a b", "load t1", "drive t1 b c", "drop t1"), PLAN.roots)
    plan = replace(plan, roots=deliver(1, node("go t1 c", "via", 0, node("go t1 c", "direct", 2)), 3))
    assert reasons(plan) == "step 1 (drive t1 a b): it must come after step 2 (load t1)"


def test_parameters_of_the_initial_network_are_solved_for() -> None:
    parameters = variables(v="truck", y="city", other="place")
    wanted = network("deliver ?v ?y", constraints=And((Not(Equals("?other", "?y")), OfType("?other", ("city",)))))
    problem = replace(PROBLEM, parameters=parameters, network=wanted)
    assert validate(problem, replace(PLAN, root_bindings=None))
    assert validate(problem, replace(PLAN, root_bindings=("t1", "c", "b")))
    for bindings, reason in [
        (("t1", "c", "c"), "its constraints do not hold"),
        (("t1", "c", "a"), "its constraints do not hold"),
        (("t1", "b", "b"), "expected subtask (deliver t1 b), found (deliver t1 c)"),
        ((), "expected 3 arguments, found 0"),
    ]:
        assert reason in reasons(replace(PLAN, root_bindings=bindings), problem)
    impossible = replace(problem, network=network("deliver ?v ?y", constraints=Equals("?other", "?v")))
    assert "its constraints do not hold" in reasons(replace(PLAN, root_bindings=None), impossible)


def test_method_variables_that_only_the_precondition_binds() -> None:
    helper = Method(
        "with-help",
        variables(v="truck", y="place", w="truck", z="place"),
        "deliver",
        ("?v", "?y"),
        network("load ?v", "go ?v ?y", "drop ?v", constraints=Not(Equals("?v", "?w"))),
        And((atom("at ?w ?z"), atom("road ?y ?z"))),
    )
    problem = replace(PROBLEM, domain=replace(DELIVERY, methods={**DELIVERY.methods, "with-help": helper}))
    plan = replace(PLAN, roots=(node("deliver t1 c", "with-help", 0, GO, 3),))
    assert validate(problem, plan)
    assert not validate(replace(problem, initial_state=problem.initial_state - {("at", "t2", "b")}), plan)
    alone = replace(problem, objects={"t1": "truck", "a": "place", "b": "city", "c": "city"})
    assert "its constraints do not hold" in reasons(plan, alone)
    elsewhere = replace(problem, initial_state=(problem.initial_state - {("at", "t2", "b")}) | {("at", "t2", "a")})
    assert "does not hold from the initial state on and before step 1: no ?w - truck, ?z - place makes" in reasons(
        plan, elsewhere
    )


def test_an_empty_method_needs_its_precondition_too() -> None:
    stay = deliver(0, node("go t1 c", "stay"), 1)
    at_c = replace(PROBLEM, initial_state=frozenset({("at", "t1", "c")}))
    assert validate(at_c, Plan(steps("load t1", "drop t1"), stay))
    text = reasons(Plan(steps("load t1", "drop t1"), stay), replace(PROBLEM, goal=TRUE))
    assert "method 'stay' of (go t1 c): its precondition does not hold after step 1: (at t1 c) is false" in text


def test_an_undefined_cost_is_an_input_error() -> None:
    toll = CostBlock(((Number(Fraction(1)), FunctionTerm("toll")),))
    load = replace(DELIVERY.actions["load"], costs=(toll,))
    problem = replace(PROBLEM, domain=replace(DELIVERY, actions={**DELIVERY.actions, "load": load}))
    with pytest.raises(InputError, match="the value of \\(toll\\) is not defined"):
        validate(problem, PLAN)


def one_action(action: Action, goal: Formula, objects: dict[str, str] | None = None) -> Problem:
    domain = Domain("d", TypeHierarchy({"place": ()}), actions={"do": action})
    return Problem("p", domain, objects or {}, network=network("do"), goal=goal)


DO = Plan((Step("do"),), (0,))


def test_effects_see_the_state_before_and_adding_wins() -> None:
    effects = (
        *deletes("p"),
        *adds("p", "q"),
        Effect(atom("r"), condition=atom("q")),
        Effect(atom("s"), condition=Not(atom("q"))),
    )
    goal = And((atom("p"), atom("q"), atom("s"), Not(atom("r"))))
    assert validate(replace(one_action(Action("do", effects=effects), goal), initial_state=frozenset({("p",)})), DO)


def test_universal_effects_and_costs() -> None:
    places = variables(x="place")
    effects = (Effect(atom("seen ?x"), condition=Not(atom("dark ?x")), parameters=places),)
    pay = cost(5, Or((atom("toll ?x"), atom("dark ?x"))), places)
    everywhere = Forall(places, Or((atom("dark ?x"), atom("seen ?x"))))
    objects = {"a": "place", "b": "place", "c": "place"}
    problem = replace(
        one_action(Action("do", effects=effects, costs=(pay,)), everywhere, objects),
        initial_state=frozenset({("dark", "a"), ("toll", "a"), ("toll", "b")}),
    )
    assert validate(problem, DO).expected_cost == 10
    assert not validate(replace(problem, goal=Exists(places, And((atom("dark ?x"), atom("seen ?x"))))), DO)
    assert not validate(replace(problem, goal=Forall(places, atom("seen ?x"))), DO)
    assert validate(replace(problem, goal=Exists(places, And((Not(atom("toll ?x")), atom("seen ?x"))))), DO)


def test_quantified_variables_hide_outer_ones() -> None:
    places = variables(x="place")
    precondition = And((atom("dark ?x"), Exists(places, Not(atom("dark ?x")))))
    domain = Domain("d", TypeHierarchy({"place": ()}), actions={"do": Action("do", places, precondition)})
    problem = Problem(
        "p", domain, {"a": "place", "b": "place"}, network=network("do a"), initial_state=frozenset({("dark", "a")})
    )
    assert validate(problem, Plan((Step("do", ("a",)),), (0,)))
    assert validate(problem, Plan((Step("do", ("a",)),), (0,))).expected_cost == 1  # no costs: units


def test_a_plan_that_a_limit_leaves_unchecked_does_not_fail() -> None:
    unchecked = Validation(("the time was short",), (), stopped=Status.TIME_LIMIT)
    text = readable_validation(unchecked, ["(go)"])
    assert "not reached" in text
    assert "fails" not in text
    verdict, why = readable_validation(unchecked, []).strip().splitlines()
    assert verdict.split() == ["verdict", "not", "decided"]
    assert why.endswith("the time was short")
