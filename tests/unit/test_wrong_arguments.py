"""Public functions with arguments of wrong types: each says what was expected; none fails inside."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import pytest

import statehtn
from statehtn import CostDistribution, ProblemBuilder
from tests.test_minimal import DOMAIN, PROBLEM

NONSENSE: list[object] = [
    *(None, True, 3, -1, 2.5, float("nan"), float("inf"), 10**400, "nonsense", "", b"x", object(), object, len),
    *(Fraction(1, 2), Decimal("2.5")),
    *([], [1], [None], [[0.5, "a"]], [("a", "b")], (1, 2, 3), {}, {1: 2}, {"a": "b"}, {1: None}, {None: None}),
]
Call = tuple[Callable[..., Any], list[Any], dict[str, Any]]
"""A function with good arguments, by place and by name."""


def builder_of(domain: bool = True) -> ProblemBuilder:
    builder = ProblemBuilder("trip")
    if domain:
        place = builder.type("place")
        here, there = place.variables("here", "there")
        place.objects("home", "shop")
        at = builder.predicate("at", here)
        builder.function("fare", here, there)
        builder.task("travel", there)
        builder.action("drive", [here, there], precondition=at(here), effects=[at(there), ~at(here)], cost=2)
        builder.set_network(builder.tasks["travel"]("home"))
    return builder


def on_a_new_builder(method: str, domain: bool = True) -> Callable[..., Any]:
    return lambda *given, **named: getattr(builder_of(domain), method)(*given, **named)


def calls(folder: Path) -> dict[str, Call]:
    files = {"d": DOMAIN, "p": PROBLEM, "c": '[[costs]]\naction = "take-car"\ncost = 3\n', "days": "take-car\n3\n"}
    for name, text in files.items():
        (folder / name).write_text(text)
    problem = statehtn.read_hddl_text(DOMAIN, PROBLEM)
    result = statehtn.plan(problem)
    plan = result.plan
    assert plan is not None
    validation = statehtn.validate(problem, plan)
    law, samples = CostDistribution.of([(0.5, 1), (0.5, 2)]), CostDistribution.from_samples([1, 2])
    averse, neutral = statehtn.utility_for("averse", 0.5), statehtn.utility_for("neutral")
    limits = {"time_limit": 1.0, "memory_limit": 1e6, "progress": None}
    agent = {"attitude": "averse", "alpha": 1.0}
    built = builder_of()
    (here,), at, travel = built.types["place"].variables("here"), built.predicates["at"], built.tasks["travel"]
    drive, fare = built.tasks["drive"], built.functions["fare"]
    comparison = statehtn.compare_attitudes(problem)
    found: dict[str, Call] = {
        "plan": (
            statehtn.plan,
            [problem],
            {**agent, "solver": "state", "heuristic": "lmcut", "search": "astar", "weight": None, "branch": None}
            | limits,
        ),
        "improving": (lambda *given, **named: list(statehtn.improving(*given, **named)), [problem], agent | limits),
        "top_plans": (
            statehtn.top_plans,
            [problem, 2],
            {**agent, "distinct": "sequence", "heuristic": "lmcut"} | limits,
        ),
        "compare_attitudes": (
            statehtn.compare_attitudes,
            [problem],
            {"alpha": 1.0, "attitudes": ["averse"], "solver": "state", "heuristic": "lmcut", "search": "astar"}
            | limits,
        ),
        "frontier": (statehtn.frontier, [problem, "cvar 0.9"], {"precision": 1e-3} | limits),
        "attitude_map": (
            statehtn.attitude_map,
            [problem, -0.5, 0.5],
            {"eps": 0.5, "resolution": 0.1, "solver": "state", "heuristic": "lmcut"} | limits,
        ),
        "check": (statehtn.check, [folder / "d", folder / "p"], {"time_limit": 5.0}),
        "why": (statehtn.why, [problem, plan], {"time_limit": 5.0}),
        "policy": (statehtn.policy, [problem], {"objective": "deadline 3", "adaptive": True, "time_limit": 5.0}),
        "sequence_cost": (statehtn.sequence_cost, [problem, plan], {"failure_cost": 2.0, "time_limit": 5.0}),
        "trajectory_utility": (statehtn.trajectory_utility, [[(0.5, 2.0)], lambda cost: -cost], {}),
        "survey": (statehtn.survey, [problem, -0.5, 0.5], {"time_limit": 5.0}),
        "validate": (statehtn.validate, [problem, plan], {}),
        "read_hddl": (statehtn.read_hddl, [folder / "d", folder / "p"], {"strict": False}),
        "read_hddl_text": (statehtn.read_hddl_text, [DOMAIN, PROBLEM], {"domain_file": "d", "problem_file": "p"}),
        "write_hddl": (statehtn.write_hddl, [problem], {}),
        "read_plan": (statehtn.read_plan, [statehtn.write_plan(plan, problem), problem], {"file": "x"}),
        "write_plan": (statehtn.write_plan, [plan, problem], {}),
        "read_costs": (statehtn.read_costs, [folder / "c"], {}),
        "read_joint_samples": (statehtn.read_joint_samples, [folder / "days"], {}),
        "CostTable.apply": (statehtn.read_costs(folder / "c").apply, [problem], {}),
        "tabulate_costs": (statehtn.tabulate_costs, [problem], {}),
        "objective": (statehtn.objective, ["cvar 0.95"], {}),
        **{
            text: (partial(value_of, kind), [*given], {})
            for text, kind, *given in (
                ("MeanVariance", statehtn.MeanVariance, 0.5),
                ("OneSwitch", statehtn.OneSwitch, 0.5, 1.0, 3.0),
                ("Exponentials", statehtn.Exponentials, 1.0, [(0.5, 2.0)]),
                ("MeanDeviation", statehtn.MeanDeviation, 0.5),
                ("EntropicValueAtRisk", statehtn.EntropicValueAtRisk, 0.5),
                ("Deadline", statehtn.Deadline, 3.0),
                ("Overrun", statehtn.Overrun, 3.0),
                ("Piecewise", statehtn.Piecewise, [(0, 0), (3, -1)]),
                ("Quantile", statehtn.Quantile, 0.5),
                ("ConditionalValueAtRisk", statehtn.ConditionalValueAtRisk, 0.5),
                ("MeanCvar", statehtn.MeanCvar, 0.5, 0.5),
                ("CallableUtility", statehtn.CallableUtility, lambda cost: -cost),
            )
        },
        "Keep": (statehtn.Keep, [25.0, 0.95], {}),
        "Keep.of": (statehtn.Keep.of, ["25 0.95"], {}),
        "keep.holds": (statehtn.Keep(25.0, 0.95).holds, [CostDistribution.certain(2)], {}),
        "cvar.value": (statehtn.objective("cvar 0.95").value, [CostDistribution.certain(2)], {}),
        "law.expectation": (CostDistribution.certain(2).expectation, [lambda cost: cost], {}),
        "law.expected_overrun": (CostDistribution.certain(2).expected_overrun, [3.0], {}),
        "law.semi_deviation": (CostDistribution.certain(2).semi_deviation, [3.0], {}),
        "law.entropic": (CostDistribution.certain(2).entropic, [3.0], {}),
        "law.evar": (CostDistribution.certain(2).evar, [0.5], {}),
        "utility_for": (statehtn.utility_for, ["averse", 1.0], {}),
        "alpha_of": (statehtn.alpha_of, [1.4, law], {}),
        "Exponential": (statehtn.Exponential, [statehtn.Attitude.AVERSE, 0.5], {}),
        "with_cost": (statehtn.with_cost, [problem, "take-car", 3.0], {"when": None}),
        "when": (statehtn.when, [at(here), at(here)], {}),
        "forall": (statehtn.forall, [[here], at(here)], {}),
        "exists": (statehtn.exists, [[here], at(here)], {}),
        "equal": (statehtn.equal, [here, "home"], {}),
        "chance": (statehtn.chance, [(0.5, 1), (0.5, 2)], {}),
        "CostDistribution.of": (CostDistribution.of, [[(0.5, 1), (0.5, 2)]], {}),
        "CostDistribution.certain": (CostDistribution.certain, [2.0], {}),
        "CostDistribution.from_samples": (CostDistribution.from_samples, [[1, 2]], {"most": 3.0}),
        "CostDistribution.from_counts": (CostDistribution.from_counts, [{1: 2}], {"prior": 3.0}),
        **{f"law.{name}": (getattr(law, name), [0.5], {}) for name in ("cdf", "exceedance", "quantile", "cvar")},
        **{f"law.{name}": (getattr(law, name), [0.5], {}) for name in ("exponential_mean", "exponential_mean_error")},
        "law.convolve": (law.convolve, [law], {}),
        "law.curve": (law.curve, [5], {}),
        "samples.band": (samples.band, [0.9], {}),
        "samples.risk_cost_bounds": (samples.risk_cost_bounds, [averse, 0.9], {}),
        **{f"averse.{name}": (getattr(averse, name), [2.0], {}) for name in ("utility", "log10_expected_utility")},
        "neutral.utility": (neutral.utility, [2.0], {}),
        "averse.risk_cost": (averse.risk_cost, [law], {}),
        "neutral.risk_cost": (neutral.risk_cost, [law], {}),
        "averse.expected_utility_text": (averse.expected_utility_text, [2.0, 10], {}),
        "neutral.expected_utility_text": (neutral.expected_utility_text, [2.0, 10], {}),
        "plan.simulate": (plan.simulate, [10, 1], {}),
        "plan.with_costs": (plan.with_costs, [validation.costs], {}),
        "validation.risk_cost": (validation.risk_cost, [averse], {}),
        "comparison.differences": (comparison.differences, [0, 1], {}),
        "ProblemBuilder": (ProblemBuilder, ["x", "y"], {}),
        "ProblemBuilder.of": (ProblemBuilder.of, [problem], {}),
        "builder.type": (on_a_new_builder("type"), ["vehicle", None], {}),
        **{
            f"builder.{name}": (on_a_new_builder(name, domain=False), ["new"], {})
            for name in ("predicate", "function", "task")
        },
        "builder.predicate, parameters": (lambda parameter: builder_of().predicate("new", parameter), [here], {}),
        "builder.action": (
            on_a_new_builder("action"),
            ["new", [here]],
            {"precondition": at(here), "effects": [at(here)], "cost": 2},
        ),
        "builder.method": (
            on_a_new_builder("method"),
            ["new", travel(here), [drive(here, here)]],
            {
                "parameters": [here],
                "ordering": "total",
                "precondition": at(here),
                "constraints": statehtn.equal(here, here),
            },
        ),
        "builder.set_network": (
            on_a_new_builder("set_network"),
            [travel("home")],
            {"parameters": (), "ordering": "total"},
        ),
        "builder.initially": (on_a_new_builder("initially"), [at("home")], {}),
        "builder.set_goal": (on_a_new_builder("set_goal"), [at("home")], {}),
        "builder.set_values": (on_a_new_builder("set_values"), [{fare("home", "shop"): 3}], {}),
        "builder.set_cost": (on_a_new_builder("set_cost"), ["drive", 3], {"when": None}),
        "type.variables": (built.types["place"].variables, ["x"], {}),
        "type.objects": (lambda name: builder_of().types["place"].objects(name), ["x"], {}),
        "type.constants": (lambda name: builder_of().types["place"].constants(name), ["x"], {}),
        "predicate()": (at, ["home"], {}),
        "function()": (fare, ["home", "shop"], {}),
        "task()": (travel, ["home"], {"label": "k"}),
    }
    return found


def calls_of_other_libraries() -> dict[str, Call]:
    problem = statehtn.read_hddl_text(DOMAIN, PROBLEM)
    plan = statehtn.plan(problem).plan
    assert plan is not None
    return {
        "relax": (statehtn.relax, [problem], {"attitude": "averse", "alpha": 1.0}),
        "relax_to_pddl": (statehtn.relax_to_pddl, [problem], {"attitude": "averse", "alpha": 1.0}),
        "to_unified_planning": (statehtn.to_unified_planning, [problem], {}),
        "from_unified_planning": (statehtn.from_unified_planning, [statehtn.to_unified_planning(problem)], {}),
        "cost_distributions": (statehtn.cost_distributions, [problem], {}),
        "law.plot": (CostDistribution.certain(2).plot, [None], {}),
        "tree.plot": (plan.decomposition.plot, [None], {}),
    }


def value_of(kind: Callable[..., statehtn.Objective], *given: object) -> float:
    """Make an objective, and ask it for the value of a cost."""
    return kind(*given).value(CostDistribution.of([(0.5, 1), (0.5, 4)]))


def failures(name: str, call: Call) -> list[str]:
    """Return how a function fails inside when one of its arguments is nonsense."""
    function, given, named = call
    function(*given, **named)
    found = []
    for slot in (*range(len(given)), *named):
        for value in NONSENSE:
            arguments, options = list(given), dict(named)
            if isinstance(slot, int):
                arguments[slot] = value
            else:
                options[slot] = value
            if slot == "progress" and callable(value):
                continue  # what the caller's function does is the caller's
            try:
                function(*arguments, **options)
            except statehtn.StateHtnError:
                continue
            except Exception as error:
                found.append(f"{name}, {slot} = {value!r:.40}: {type(error).__name__}: {error}")
    return found


def test_wrong_arguments_are_explained(tmp_path: Path) -> None:
    found = [failure for name, call in calls(tmp_path).items() for failure in failures(name, call)]
    assert not found, "\n".join(found)


def test_wrong_arguments_of_what_needs_other_libraries() -> None:
    pytest.importorskip("unified_planning")
    pytest.importorskip("matplotlib").use("Agg")
    found = [failure for name, call in calls_of_other_libraries().items() for failure in failures(name, call)]
    assert not found, "\n".join(found)


def test_no_public_function_is_left_out(tmp_path: Path) -> None:
    functions = {name for name in statehtn.__all__ if inspect.isfunction(getattr(statehtn, name))}
    tried = {*calls(tmp_path), "relax", "relax_to_pddl", "to_unified_planning", "from_unified_planning"}
    assert functions - tried == {"cost_distributions", "register"}  # the first is tried with other libraries


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: statehtn.plan("d.hddl"), "statehtn.read_hddl(domain, problem)"),
        (lambda: statehtn.plan(ProblemBuilder("x")), "build()"),
        (lambda: statehtn.validate(builder_of().build(), Path("plan.txt")), "statehtn.read_plan(text, problem)"),
        (lambda: statehtn.write_plan(statehtn.plan(builder_of().build()), builder_of().build()), "no plan"),
        (lambda: statehtn.read_hddl("(define (domain d))", "p"), "read_hddl_text"),
        (lambda: statehtn.read_hddl_text(Path("d"), "p"), "read_hddl reads files"),
        (lambda: statehtn.plan(builder_of().build(), search="astra"), "did you mean 'astar'?"),
        (lambda: statehtn.plan(builder_of().build(), attitude="avers"), "did you mean 'averse'?"),
        (lambda: CostDistribution.of({2: 0.8, 6: 0.2}), "CostDistribution.of([(0.8, 2), (0.2, 6)])"),
        (lambda: CostDistribution.of([2, 6]), "CostDistribution.from_samples"),
    ],
)
def test_what_to_write_instead(call: Callable[[], object], words: str) -> None:
    with pytest.raises(statehtn.UsageError) as error:
        call()
    assert words in str(error.value)


def test_what_people_write_works() -> None:
    builder = builder_of()
    travel, drive = builder.tasks["travel"], builder.tasks["drive"]
    here, there = builder.types["place"].variables("here", "there")
    ways = drive(here, there), drive(there, here)
    builder.method("by-car", travel(here), *ways, parameters=(here, there))
    builder.set_network(travel("home"), travel("home"))
    builder.initially(builder.predicates["at"]("home"))
    plan = statehtn.plan(builder.build()).plan
    assert plan is not None
    assert len(plan.steps) == 4
    assert (plan.simulate(3) == plan.simulate(3)).all()
    assert statehtn.compare_attitudes(builder.build(), attitudes="neutral").agents == ("neutral",)


def test_infinite_limits_are_none() -> None:
    result = statehtn.plan(statehtn.read_hddl_text(DOMAIN, PROBLEM), time_limit=float("inf"), memory_limit=float("inf"))
    assert result.status is statehtn.Status.OPTIMAL
