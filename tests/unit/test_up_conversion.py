"""Problems of unified-planning as ours and ours as its: examples, names, and what is refused."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import unified_planning.exceptions as up_exceptions
import unified_planning.shortcuts as up
from unified_planning.model.htn import HierarchicalProblem, Method
from unified_planning.plans import HierarchicalPlan, SequentialPlan
from unified_planning.plans.hierarchical_plan import Decomposition as UpDecomposition
from unified_planning.plans.hierarchical_plan import MethodInstance
from unified_planning.test.examples.hierarchical import get_example_problems

import statehtn
from statehtn import (
    CostDistribution,
    InputError,
    Problem,
    ProblemBuilder,
    UnsupportedError,
    UsageError,
    chance,
    validate,
)
from statehtn.interop import Conversion
from statehtn.model import And, Decomposition, Equals, Not, OfType, Parameter, Plan
from tests.normal_form import normal_form

DOMAINS = Path(__file__).parents[2] / "domains"


def repository_problem(name: str) -> Problem:
    domain, problem = name.split("/")
    return statehtn.read_hddl(DOMAINS / domain / "domain.hddl", DOMAINS / domain / f"{problem}.hddl")


@pytest.mark.parametrize("name", ["marine/p1", "satellite/RA-3obs-1sat-3mod", "satellite/RA-4obs-1sat-3mod-unordered"])
def test_domains_of_the_repository_there_and_back(name: str) -> None:
    problem = repository_problem(name)
    distributions = statehtn.cost_distributions(problem)
    assert distributions
    conversion = Conversion.to_up(problem)
    back = statehtn.from_unified_planning(conversion.up_problem, distributions)
    assert normal_form(back) == normal_form(with_methods_renamed(problem, conversion))
    result = statehtn.plan(back, attitude="averse", alpha=0.01, search="greedy", time_limit=60)
    assert result.plan is not None
    theirs = Conversion.from_up(conversion.up_problem).plan_to_up(result.plan)
    assert validate(problem, conversion.plan_from_up(theirs)).risk_cost(result.utility) == pytest.approx(
        result.risk_cost
    )


def with_methods_renamed(problem: Problem, conversion: Conversion) -> Problem:
    """The problem with UP's names of methods: some have the name of a task, too."""
    theirs = conversion.names.methods.theirs
    methods = {theirs(name): replace(one, name=theirs(name)) for name, one in problem.domain.methods.items()}
    return replace(problem, domain=replace(problem.domain, methods=methods))


def test_costs_that_depend_on_the_state_are_refused() -> None:
    p1 = repository_problem("av/p1")
    for convert in (statehtn.to_unified_planning, statehtn.cost_distributions):
        with pytest.raises(UnsupportedError, match=r"action 'accelerate' depends on the state"):
            convert(p1)


def small() -> tuple[ProblemBuilder, Any, Any]:
    """A walker who may go from a to b."""
    build = ProblemBuilder("small", "walking")
    place = build.type("place")
    a, b = place.objects("a", "b")
    here, there = place.variables("here", "there")
    at = build.predicate("at", here)
    walk = build.action("walk", [here, there], precondition=at(here), effects=[~at(here), at(there)], cost=2)
    go = build.task("go", there)
    build.method("on-foot", go(there), walk(here, there), parameters=[here, there], precondition=at(here))
    build.initially(at(a))
    build.set_network(go(b))
    return build, walk, place


def test_expected_costs_and_distributions_part_ways() -> None:
    build, walk, _ = small()
    build.set_cost(walk, chance((0.25, 4), (0.75, 8)), 1)
    problem = build.build()
    theirs = statehtn.to_unified_planning(problem)
    (metric,) = theirs.quality_metrics
    assert metric.costs[theirs.action("walk")].constant_value() == 8
    assert normal_form(statehtn.from_unified_planning(theirs, statehtn.cost_distributions(problem))) == normal_form(
        problem
    )
    build.set_cost(walk, 2)
    assert statehtn.cost_distributions(build.build()) == {}
    build.set_cost(walk, lambda *_: CostDistribution.of([(0.5, 1), (0.5, 2)]))
    assert list(statehtn.cost_distributions(build.build())) == ["walk"]
    with pytest.raises(UnsupportedError, match="tabulate_costs"):
        statehtn.to_unified_planning(build.build())
    tabulated = statehtn.to_unified_planning(statehtn.tabulate_costs(build.build()))
    assert statehtn.plan(statehtn.from_unified_planning(tabulated)).risk_cost == 1.5


def test_free_actions_stay_free() -> None:
    build, walk, _ = small()
    build.set_cost(walk, 0)
    theirs = statehtn.to_unified_planning(build.build())
    theirs.clear_quality_metrics()
    theirs.add_quality_metric(up.MinimizeActionCosts({}))
    assert statehtn.plan(statehtn.from_unified_planning(theirs)).risk_cost == 0
    theirs.clear_quality_metrics()
    assert statehtn.plan(statehtn.from_unified_planning(theirs)).risk_cost == 1
    theirs.add_quality_metric(up.MinimizeActionCosts({}, default=3))
    assert statehtn.plan(statehtn.from_unified_planning(theirs)).risk_cost == 3


def test_names_that_two_things_share() -> None:
    build = ProblemBuilder("same", "same")
    kind = build.type("go")
    one = kind.objects("same")[0]
    x = kind.variable("x")
    fact = build.predicate("go", x)
    step = build.action("step", [x], effects=fact(x))
    go = build.task("go", x)
    build.method("go", go(x), step(x))
    build.method("step", go(x), [step(x), step(x)])
    build.set_network(go(one))
    conversion = Conversion.to_up(build.build())
    assert [method.name for method in conversion.up_problem.methods] == ["go-method", "step-method"]
    assert [fluent.name for fluent in conversion.up_problem.fluents] == ["go-predicate"]
    result = statehtn.plan(conversion.problem)
    theirs = conversion.plan_to_up(result.plan)
    assert conversion.plan_from_up(theirs) == replace(result.plan, root_bindings=())
    back = Conversion.from_up(conversion.up_problem)
    assert validate(back.problem, back.plan_from_up(theirs))


def test_names_that_hddl_does_not_have() -> None:
    made = HierarchicalProblem("A (strange) problem; really")
    thing = up.UserType("And")
    made.add_object("O 1", thing)
    made.add_object("o_1", thing)
    made.add_object("?x", thing)
    done = made.add_fluent("=", p=thing, default_initial_value=False)
    act = up.InstantaneousAction("Act", x=thing, X=thing)
    act.add_effect(done(act.x), True)
    act.add_effect(done(act.X), True)
    made.add_action(act)
    task = made.add_task("act", a=thing)
    method = Method("-m", a=thing, b=thing)
    method.set_task(task, method.a)
    method.add_subtask(act, method.a, method.b)
    made.add_method(method)
    made.task_network.add_subtask(task, made.object("O 1"))
    made.add_goal(done(made.object("?x")))
    problem = statehtn.from_unified_planning(made)
    text = statehtn.write_hddl(problem)
    assert statehtn.read_hddl_text(*text, strict=True) == problem
    assert list(problem.all_objects) == ["O_1", "o_1-2", "x"]
    conversion = Conversion.from_up(made)
    plan = statehtn.plan(conversion.problem).plan
    assert str(conversion.plan_to_up(plan).action_plan.actions[0]) == "Act(O 1, ?x)"


def test_object_fluents_and_expressions() -> None:
    made = HierarchicalProblem("expressions")
    thing = up.UserType("thing")
    things = [made.add_object(f"t{i}", thing) for i in range(3)]
    following = made.add_fluent("following", thing, x=thing, default_initial_value=things[0])
    chosen = made.add_fluent("chosen", thing, default_initial_value=things[1])
    flag = made.add_fluent("flag", default_initial_value=False)
    both = made.add_fluent("both", x=thing, default_initial_value=True)
    made.set_initial_value(following(things[1]), things[2])
    made.set_initial_value(both(things[0]), False)
    act = up.InstantaneousAction("act")
    act.add_precondition(up.Iff(both(chosen), up.Not(flag)))
    act.add_precondition(up.Equals(following(following(chosen)), things[0]))  # following(t1) is t2, then t0
    act.add_precondition(up.Implies(flag, both(things[0])))
    act.add_effect(chosen, following(chosen))
    act.add_effect(flag, up.Not(flag))
    made.add_action(act)
    other = up.Variable("o", thing)
    act.add_effect(both(other), False, up.Equals(other, chosen), forall=[other])
    go = made.add_task("go")
    method = Method("once")
    method.set_task(go)
    method.add_subtask(act)
    made.add_method(method)
    made.task_network.add_subtask(go)
    made.add_goal(up.Equals(things[2], chosen))
    made.add_goal(flag)
    made.add_goal(up.Not(both(things[1])))
    made.add_goal(up.Forall(up.Or(up.Equals(other, things[2]), up.Not(both(other))), other))
    problem = statehtn.from_unified_planning(made)
    assert statehtn.plan(problem).length == 1
    made.add_goal(up.Equals(chosen, things[1]))  # which it is no longer
    assert not statehtn.plan(statehtn.from_unified_planning(made))


def test_constraints_are_kept_both_ways() -> None:
    build, _, _ = small()
    problem = build.build()
    method = problem.domain.methods["on-foot"]
    for constraints in (
        Not(Equals("?here", "?there")),
        Equals("?there", "b"),
        And((Equals("?here", "a"), Not(Equals("?there", "a")))),
    ):
        network = replace(method.network, constraints=constraints)
        changed = replace(
            problem, domain=replace(problem.domain, methods={"on-foot": replace(method, network=network)})
        )
        theirs = statehtn.to_unified_planning(changed)
        assert theirs.kind.has_task_network_constraints()
        assert normal_form(statehtn.from_unified_planning(theirs)) == normal_form(changed)
    network = replace(method.network, constraints=OfType("?there", ("place",)))
    sorts = replace(problem, domain=replace(problem.domain, methods={"on-foot": replace(method, network=network)}))
    assert statehtn.plan(statehtn.from_unified_planning(statehtn.to_unified_planning(sorts))).length == 1


def test_what_up_cannot_hold() -> None:
    build, _, _ = small()
    problem = build.build()
    method, domain = problem.domain.methods["on-foot"], problem.domain
    wrong = replace(method, parameters=(Parameter("?here", ("place",)), Parameter("?there", ("place", "object"))))
    with pytest.raises(
        UnsupportedError, match=r"no variables of several types, found '\?there - \(either place object\)'"
    ):
        statehtn.to_unified_planning(replace(problem, domain=replace(domain, methods={"on-foot": wrong})))
    wrong = replace(method, arguments=("b",))
    with pytest.raises(UnsupportedError, match=r"method 'on-foot': it is for \(go b\)"):
        statehtn.to_unified_planning(replace(problem, domain=replace(domain, methods={"on-foot": wrong})))
    types = replace(domain.types, parents={"place": ("object",), "a": (), "b": (), "both": ("a", "b")})
    with pytest.raises(UnsupportedError, match=r"type 'both' has several supertypes \(a, b\)"):
        statehtn.to_unified_planning(replace(problem, domain=replace(domain, types=types)))


def test_what_we_do_not_read() -> None:
    theirs = statehtn.to_unified_planning(small()[0].build())
    with pytest.raises(UsageError, match="expected a HierarchicalProblem of unified-planning, found a Problem"):
        statehtn.from_unified_planning(up.Problem())
    undefined = theirs.clone()
    undefined.add_fluent("unknown")
    with pytest.raises(UnsupportedError, match="fluent 'unknown' has no initial value"):
        statehtn.from_unified_planning(undefined)
    timed = theirs.clone()
    timed.add_timed_goal(up.GlobalStartTiming(5), up.TRUE())
    with pytest.raises(UnsupportedError, match="timed goals"):
        statehtn.from_unified_planning(timed)
    two = theirs.clone()
    two.add_quality_metric(up.MinimizeMakespan())
    with pytest.raises(UnsupportedError, match="MinimizeActionCosts or MinimizeSequentialPlanLength, found .*Makespan"):
        statehtn.from_unified_planning(two)
    with pytest.raises(UnsupportedError, match="action 'durative_move' is not an instantaneous action"):
        statehtn.from_unified_planning(get_example_problems()["htn-go-temporal"].problem)


def test_plans_that_do_not_fit() -> None:
    conversion = Conversion.to_up(small()[0].build())
    plan = statehtn.plan(conversion.problem).plan
    theirs = conversion.plan_to_up(plan)
    with pytest.raises(UsageError, match="expected a HierarchicalPlan over a SequentialPlan, found a SequentialPlan"):
        conversion.plan_from_up(SequentialPlan([]))
    other = Conversion.from_up(get_example_problems()["htn-go"].problem)
    with pytest.raises(InputError, match="'walk', which the problem does not know"):
        other.plan_from_up(theirs)
    (identifier,) = theirs.decomposition.subtasks
    instance = theirs.decomposition.subtasks[identifier]
    short = MethodInstance(instance.method, instance.parameters[:1], instance.decomposition)
    with pytest.raises(InputError, match="method 'on-foot' has 2 parameters, found"):
        conversion.plan_from_up(HierarchicalPlan(theirs.action_plan, UpDecomposition({identifier: short})))
    (root,) = plan.roots
    assert isinstance(root, Decomposition)
    with pytest.raises(UsageError, match="does not tell the arguments of its methods"):
        conversion.plan_to_up(Plan(plan.steps, (replace(root, bindings=None),)))


def test_deep_plans() -> None:
    build = ProblemBuilder("deep")
    step = build.action("step")
    go = build.task("go")
    build.method("on", go(), [step(), go()])
    build.method("end", go())
    build.set_network(go())
    conversion = Conversion.to_up(build.build())
    node = Decomposition("go", (), "end", (), ())
    for number in reversed(range(3000)):
        node = Decomposition("go", (), "on", (number, node), ())
    plan = Plan((statehtn.Step("step"),) * 3000, (node,))
    steps = conversion.plan_to_up(plan).action_plan.actions
    assert len(steps) == 3000


KITCHEN = """(define (domain kitchen) (:types cup plate bowl - dish tool)
(:constants ladle - tool)
(:predicates (clean ?d - dish) (dry ?t - tool))
(:task wash :parameters (?d - plate))
(:task use :parameters (?d - dish))
(:method m :parameters (?t - tool ?c - cup ?p - plate) :task (wash ?p) :precondition {}
  :subtasks (rinse ?p) :constraints {})
(:action rinse :parameters (?p - plate) :effect (clean ?p)))"""
TABLE = "(define (problem p) (:objects blue - cup round - plate) (:htn :subtasks (wash round)) (:init) (:goal {}))"


@pytest.mark.filterwarnings("ignore:.*not a constant of the domain")
@pytest.mark.parametrize(
    ("precondition", "constraint", "solvable"),
    [
        ("(not (= ?t ?p))", "()", True),
        ("(= ?t ?p)", "()", False),
        ("()", "(not (= ?t ?p))", True),
        ("()", "(= ?p ?t)", False),
        ("()", "(or (= ?t ?p) (not (= ?c ?p)))", True),
        ("(not (= ladle ?p))", "()", True),
        ("(= round ?p)", "()", True),
        ("(= ?p ladle)", "()", False),
        ("(exists (?x - tool) (= ?x ?p))", "()", False),
        ("(forall (?x - tool) (not (= ?x ?c)))", "(sortof ?t - tool)", True),
        ("()", "(not (sortof ?p - tool))", True),
        ("()", "(sortof ?p - tool)", False),
    ],
)
def test_terms_whose_types_share_no_object_are_not_equal(precondition: str, constraint: str, solvable: bool) -> None:
    ours = statehtn.read_hddl_text(KITCHEN.format(precondition, constraint), TABLE.format("(clean round)"))
    again = statehtn.from_unified_planning(statehtn.to_unified_planning(ours))
    assert [statehtn.plan(problem).plan is not None for problem in (ours, again)] == [solvable, solvable]


@pytest.mark.filterwarnings("ignore:.*there is no plan")
@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("()\n  :subtasks", "(new ?q)\n  :subtasks", "method 'm': in (new ?q) a term's type is wider"),
        (":effect (clean ?p)", ":effect (forall (?q - dish) (new ?q))", "action 'rinse': in (new ?q) a term's type is"),
        ("(?d - plate)", "(?d - (either plate cup))", "task 'wash': UP has no variables of several types"),
        ("(new ?p - plate)", "(new ?d - (either cup plate))", "predicate 'new': UP has no variables of several types"),
    ],
)
def test_what_is_not_well_formed_there_is_unsupported_and_has_a_place(old: str, new: str, message: str) -> None:
    domain = KITCHEN.format("()", "()").replace("?c - cup", "?c - cup ?q - dish")
    domain = domain.replace("(dry ?t", "(new ?p - plate) (dry ?t")
    assert old in domain
    ours = statehtn.read_hddl_text(domain.replace(old, new), TABLE.format("()"))
    with pytest.raises(UnsupportedError, match=f"^{re.escape(message)}"):
        statehtn.to_unified_planning(ours)


def test_what_unified_planning_refuses_is_unsupported_and_has_a_place(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise up_exceptions.UPUsageError("for a reason of its own")

    ours = statehtn.read_hddl_text(KITCHEN.format("()", "()"), TABLE.format("()"))
    for function, place in (
        ("add_action", "action 'rinse'"),
        ("add_method", "method 'm'"),
        ("add_task", "task 'wash'"),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(HierarchicalProblem, function, refuse)
            with pytest.raises(UnsupportedError, match=f"^{place} cannot be .* for a reason of its own$"):
                statehtn.to_unified_planning(ours)
