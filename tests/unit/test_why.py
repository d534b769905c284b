"""Why there is no plan, and why it is not that plan: the answers in words, as JSON, and from Python."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

import statehtn
from statehtn.cli.program import main
from statehtn.errors import UnsupportedError, UsageError
from statehtn.explanation.explanation import why_no_plan
from statehtn.limits import Limits
from statehtn.model import Problem
from statehtn.model.status import Status
from statehtn.policies.settings import PolicySettings
from tests.pages import ROOT, blocks

PAGE = {block.title: block.text for block in blocks((ROOT / "docs" / "why.md").read_text(encoding="utf-8"))}
DOMAIN, UNREACHABLE, FORBIDDEN = (PAGE[name] for name in ("transport.hddl", "p1.hddl", "p2.hddl"))
SOLVABLE = UNREACHABLE.replace("(road home shop)", "(road home shop) (road shop port)")
AV = (str(ROOT / "domains/av/domain.hddl"), str(ROOT / "domains/av/p1.hddl"))


def read(problem: str, domain: str = DOMAIN) -> Problem:
    return statehtn.read_hddl_text(domain, problem)


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in (("d", DOMAIN), ("unreachable", UNREACHABLE), ("forbidden", FORBIDDEN), ("solvable", SOLVABLE)):
        Path(f"{name}.hddl").write_text(text, encoding="utf-8")


SLIPPERY = """(define (domain slippery)
  (:types place)
  (:predicates (at ?p - place) (road ?a ?b - place))
  (:task go :parameters (?p - place))
  (:method m-there :parameters (?p - place) :task (go ?p) :precondition (at ?p) :ordered-subtasks ())
  (:method m-drive :parameters (?p ?a ?b - place) :task (go ?p) :precondition (and (at ?a) (road ?a ?b))
    :ordered-subtasks (and (drive ?a ?b) (go ?p)))
  (:method m-walk :parameters (?p ?a ?b - place) :task (go ?p) :precondition (and (at ?a) (road ?a ?b))
    :ordered-subtasks (and (walk ?a ?b) (go ?p)))
  (:action drive :parameters (?a ?b - place) :precondition (and (at ?a) (road ?a ?b))
    :effect (and (increase (total-cost) 1) (probabilistic 0.5 (and (not (at ?a)) (at ?b)) 0.5 ())))
  (:action walk :parameters (?a ?b - place) :precondition (and (at ?a) (road ?a ?b))
    :effect (and (increase (total-cost) 2) (probabilistic 0.9 (and (not (at ?a)) (at ?b)) 0.1 (not (at ?a))))))"""
SLIPPERY_ROADS = """(define (problem p) (:domain slippery) (:objects a b c - place)
  (:htn :ordered-subtasks (and (go c))) (:init (at a) (road a b) (road b c)))"""


def test_plans_that_count_on_outcomes() -> None:
    problem = read(SLIPPERY_ROADS, SLIPPERY)
    objective = "success-utility alpha=0.1"
    answer = statehtn.why(problem, ["(drive a b)", "(walk b c)"], objective=objective)
    assert isinstance(answer, statehtn.WhyNot)
    assert answer.given is not None
    by_walking, by_driving = 0.2 - math.log(0.9), 0.1 - math.log(0.5)
    assert answer.given.value == pytest.approx(by_driving + by_walking)
    assert answer.more == pytest.approx(by_driving - by_walking)
    (part,) = answer.differences
    assert part.own_cost == pytest.approx(by_driving)
    assert part.other_cost == pytest.approx(by_walking)
    again = statehtn.why(problem, ["(drive a b)", "(drive a b)", "(walk b c)"], objective=objective)
    assert isinstance(again, statehtn.WhyNot)
    assert again.given is not None  # the first try fails
    assert again.given.value == pytest.approx(2 * by_driving + by_walking)
    never = statehtn.why(problem, ["(walk a b)", "(walk a b)"], objective=objective)
    assert isinstance(never, statehtn.WhyNot)
    assert "(at a) is false, and no outcomes of the steps before lead farther" in never.reasons[0]
    with pytest.raises(UnsupportedError, match="a policy can"):
        statehtn.why(problem, ["(drive a b)"])


def test_outcomes_after_which_nothing_is_left() -> None:
    answer = statehtn.why(read(SLIPPERY_ROADS, SLIPPERY.replace("0.5 ()", "0.1 (not (at ?a)) 0.4 ()")))
    assert isinstance(answer, statehtn.NoPlan)
    assert answer.status is Status.UNSOLVABLE
    assert answer.chance is not None
    assert answer.chance.most_success == pytest.approx(0.81)
    assert answer.chance.is_proven
    found = [(str(bad.action), bad.probability, round(bad.reached, 9)) for bad in answer.chance.dead_ends]
    assert found == [("(walk a b)", 0.1, 0.1), ("(walk b c)", 0.1, 0.09)]
    assert "(walk a b) if it does not come to (at b), 0.1; runs of that policy come to it with" in str(answer)
    assert "--failure-cost" in str(answer)
    assert answer.to_dict()["chance"]["dead_ends"][0]["deleted"] == ["(at a)"]


DEAD_ENDS = SLIPPERY.replace("0.5 ()", "0.1 (not (at ?a)) 0.4 ()")


def test_a_dead_end_that_is_hardly_ever_met() -> None:
    hardly = DEAD_ENDS.replace("0.5 (and", "0.99999999999999999999 (and").replace(
        "0.1 (not (at ?a)) 0.4 ()", "0.00000000000000000001 (not (at ?a))"
    )
    text = str(statehtn.why(read(SLIPPERY_ROADS, hardly)))
    assert "No policy is done with probability 1: the most likely one is done with probability 1 - 2e-20." in text
    assert "(drive a b) if it does not come to (at b), 1e-20; runs of that policy come to it with" in text


def test_by_success_there_is_a_policy() -> None:
    answer = statehtn.why(read(SLIPPERY_ROADS, DEAD_ENDS), objective="success")
    assert isinstance(answer, statehtn.NoPlan)
    assert answer.status is Status.SOLVED
    assert answer.policy is not None
    assert answer.policy.success_probability == pytest.approx(0.81)
    assert [round(bad.reached, 9) for bad in answer.chance.dead_ends] == [0.1, 0.09]  # type: ignore[union-attr]
    text = str(answer)
    assert text.startswith("There is a policy that is done with probability 0.81, of ")
    assert "By 'success' no policy is better" in text
    assert "(walk b c) if it does not come to (at c), 0.1; runs of that policy come to it with probability 0.09" in text
    assert "--objective success" not in text
    found = answer.to_dict()["policy"]
    assert found["success_probability"] == found["value"] == pytest.approx(0.81)
    sure = statehtn.why(read(SLIPPERY_ROADS, SLIPPERY), objective="success")
    assert isinstance(sure, statehtn.NoPlan)
    assert sure.chance is None
    assert str(sure).startswith("There is a policy that is done with probability 1, of ")


def test_not_even_the_best_outcomes_help() -> None:
    """Whoever arrives has no key any more; and an outcome of probability 0 is none."""
    lost = SLIPPERY.replace("(at ?p - place)", "(at ?p - place) (key)").replace(
        "(and (not (at ?a)) (at ?b))", "(and (not (at ?a)) (not (key)) (at ?b))"
    )
    needed = lost.replace(":precondition (at ?p) :ordered", ":precondition (and (at ?p) (key)) :ordered")
    problem = SLIPPERY_ROADS.replace("(:init", "(:init (key)")
    never = (
        DEAD_ENDS.replace("0.5 (and", "0 (and")
        .replace("0.9 (and", "0 (and")
        .replace("0.4 ()", "0.9 ()")
        .replace("0.1 (not (at ?a))))))", "1 ()))))")
    )
    for domain, text in ((needed, "needs (key), but step"), (never, "There is no plan, though each task")):
        for objective in (None, "success"):
            answer = statehtn.why(read(problem if domain is needed else SLIPPERY_ROADS, domain), objective=objective)
            assert isinstance(answer, statehtn.NoPlan)
            assert answer.status is Status.UNSOLVABLE
            assert answer.exploration is not None
            assert text in str(answer)


@pytest.mark.parametrize(
    ("level", "failure_cost", "words"),
    [
        (
            0.9,
            None,
            "policies count that are done with probability 0.9 at least, and there is none. --objective success",
        ),
        (
            0.8,
            None,
            "policies count that are done with probability 0.8 at least, and there is one. --objective success",
        ),
        (0.9, math.inf, "No policy is done with probability 0.9, whatever it spends: the most likely one is done with"),
        (0.8, math.inf, "There is a policy that is done with probability 0.81"),
        (0.8, math.inf, "Its value by 'quantile 0.8' is finite: 4, where failed is late."),
        (0.9, 50, "Its value by 'quantile 0.9' is finite: "),
    ],
)
def test_a_level_is_a_probability_that_is_to_be_reached(level: float, failure_cost: float | None, words: str) -> None:
    problem = read(SLIPPERY_ROADS, DEAD_ENDS)
    answer = statehtn.why(problem, objective=f"quantile {level}", failure_cost=failure_cost)
    assert words in str(answer)


def test_whether_a_value_is_finite_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    gripper = [str(ROOT / f"domains/gripper-robot/{name}.hddl") for name in ("domain", "p1")]
    assert main(["why", *gripper]) == 0
    assert "Its expected cost is 5.\n" in capsys.readouterr().out
    assert main(["why", *gripper, "--objective", "averse 0.3"]) == 0
    assert "Its value by 'averse 0.3' is finite: 5.435219069.\n" in capsys.readouterr().out
    assert main(["why", *gripper, "--objective", "averse 0.7", "--failure-cost", "20"]) == 0
    assert "where failing costs 20 on top of what was spent.\n" in capsys.readouterr().out
    assert main(["why", *gripper, "--failure-cost", "20", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["policy"]
    assert found.pop("nodes") > 3
    assert found == {
        "objective": "neutral",
        "failure_cost": 20,
        "value": pytest.approx(5),
        "value_unit": "cost",
        "success_probability": 1,
        "expected_cost": pytest.approx(5),
    }


def test_a_failure_cost_is_of_policies_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["why", *AV, "--failure-cost", "3"]) == 2
    assert "a failure cost to policies" in capsys.readouterr().err
    plan = tmp_path / "plan.txt"
    plan.write_text("", encoding="utf-8")
    assert main(["why", *AV, "--plan", str(plan), "--failure-cost", "3"]) == 2
    with pytest.raises(UsageError, match="a given plan is none"):
        statehtn.why(statehtn.read_hddl(*AV), ["(stop)"], failure_cost=3)


@pytest.mark.parametrize(("steps", "what"), [(500, "plan"), (8000, "policy")])
def test_what_is_not_known_is_not_said(steps: int, what: str) -> None:
    gripper = statehtn.read_hddl(*(str(ROOT / f"domains/gripper-robot/{name}.hddl") for name in ("domain", "p4")))
    answer = why_no_plan(gripper, Limits(steps=steps), PolicySettings.of("deadline 30"))
    assert (answer.status, answer.policy, answer.to_dict()["policy"]) == (Status.TIME_LIMIT, None, None)
    assert str(answer) == f"It is not known whether there is a {what}: time limit reached before a {what} was found"


def test_policies_that_an_averse_agent_loathes() -> None:
    gripper = statehtn.read_hddl(*(str(ROOT / f"domains/gripper-robot/{name}.hddl") for name in ("domain", "p1")))
    calm = statehtn.why(gripper, objective="averse 0.3")
    assert isinstance(calm, statehtn.NoPlan)
    assert calm.status is Status.SOLVED
    assert "There is a policy that is done with probability 1" in str(calm)
    answer = statehtn.why(gripper, attitude="averse", alpha=0.7)
    assert isinstance(answer, statehtn.NoPlan)
    assert answer.chance is not None
    assert [(str(bad.action), bad.probability) for bad in answer.chance.loops] == [("(suck ball)", 0.5)]
    assert answer.chance.finite_below == pytest.approx(math.log(2))
    assert "none has a finite value by 'averse 0.7'" in str(answer)
    switch = statehtn.why(gripper, objective="one-switch alpha=0.7 tradeoff=1 wealth=9")
    assert isinstance(switch, statehtn.NoPlan)
    assert switch.chance is not None
    assert switch.chance.finite_below == pytest.approx(math.log(2))


def test_an_objective_matters_to_plans_and_policies_alone() -> None:
    with pytest.raises(UsageError, match="an objective matters to a given plan alone"):
        statehtn.why(read(UNREACHABLE), objective="averse 0.3")
    with pytest.raises(UsageError, match="plans are not compared by 'success'"):
        statehtn.why(read(SLIPPERY_ROADS, SLIPPERY), ["(walk a b)"], objective=statehtn.Success())


@pytest.mark.parametrize("command", ["plan", "policy"])
def test_three_lines_about_chance(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d.hddl").write_text(SLIPPERY.replace("0.5 ()", "0.1 (not (at ?a)) 0.4 ()"), encoding="utf-8")
    Path("p.hddl").write_text(SLIPPERY_ROADS, encoding="utf-8")
    assert main([command, "d.hddl", "p.hddl"]) == 10
    lines = capsys.readouterr().out.splitlines()[-2:]
    assert lines == [
        "why: nothing is left that could be done after (walk a b) if it does not come to (at b), 0.1",
        "'statehtn why' with the same files says more",
    ]


def test_roots_and_additions() -> None:
    answer = statehtn.why(read(UNREACHABLE))
    assert isinstance(answer, statehtn.NoPlan)
    assert answer.status is Status.UNSOLVABLE
    assert answer.reason is not None
    assert (answer.reason.kind, answer.reason.name) == ("task", "deliver")
    assert "(road ?a port): neither ':init' nor an action makes it true" in str(next(answer.reason.roots()))
    assert {str(addition) for (addition,) in answer.additions} == {
        "(at van port)",
        "(road home port)",
        "(road shop port)",
    }


def test_an_object_is_missing() -> None:
    answer = statehtn.why(read(SOLVABLE.replace("van - truck", "").replace("(at van home)", "")))
    assert isinstance(answer, statehtn.NoPlan)
    assert "an object of type 'truck' for ?t: there is none" in str(answer)
    assert [str(addition) for addition in answer.additions[0]] == [
        "an object 'new truck' of type 'truck'",
        "(at new truck home)",
    ]


def test_conditions_that_exclude_each_other() -> None:
    domain = DOMAIN.replace("(in ?p - parcel ?t - truck)", "(in ?p - parcel ?t - truck) (big ?t) (red ?t)")
    domain = domain.replace(":precondition (at ?p ?from)", ":precondition (and (at ?p ?from) (big ?t) (red ?t))")
    problem = SOLVABLE.replace("van -", "van lorry -").replace("(at van home)", "(at van home) (big lorry) (red van)")
    answer = statehtn.why(read(problem, domain))
    assert isinstance(answer, statehtn.NoPlan)
    assert "(big ?t) and (red ?t): no ?t goes together with all of these" in str(answer)
    assert "(big ?t): can be had only with ?t = lorry" in str(answer)
    assert [str(addition) for addition in answer.additions[0]] == ["(big van)"]


def test_an_action_that_no_task_leads_to() -> None:
    domain = DOMAIN.replace("(and (get-to ?t ?from) (load ?p ?t ?from) (get-to", "(and (get-to ?t ?from) (get-to")
    answer = statehtn.why(read(SOLVABLE, domain))
    assert "(load box van ?l): it could be executed, but no method contains it" in str(answer)


def test_the_order_or_deletes_forbid_it() -> None:
    answer = statehtn.why(read(FORBIDDEN))
    assert isinstance(answer, statehtn.NoPlan)
    assert (answer.status, answer.reason, answer.additions) == (Status.UNSOLVABLE, None, ())
    assert answer.exploration is not None
    (deadlock,) = answer.exploration.deadlocks
    assert [str(step) for step in deadlock.steps][-1] == "(unload box van shop)"
    assert [(lack.fact, lack.wanted, lack.changed_by) for lack in deadlock.lacks] == [(("at", "van", "home"), True, 2)]


def test_there_is_a_plan() -> None:
    answer = statehtn.why(read(SOLVABLE))
    assert isinstance(answer, statehtn.NoPlan)
    assert answer.status in (Status.SOLVED, Status.OPTIMAL)
    assert str(answer).startswith("There is a plan, of 4 actions: (drive van home shop)")


def test_a_plan_that_is_none() -> None:
    answer = statehtn.why(read(FORBIDDEN), ["(drive van home shop)", "(unload bag van home)"])
    assert isinstance(answer, statehtn.WhyNot)
    assert answer.given is None
    assert any("(unload bag van home)" in reason for reason in answer.reasons)


def test_a_plan_that_costs_more() -> None:
    problem = statehtn.read_hddl(*AV)
    plan = statehtn.plan(problem).plan
    assert plan is not None
    same, other = statehtn.why(problem, plan), statehtn.why(problem, plan, attitude="averse", alpha=0.9)
    assert isinstance(same, statehtn.WhyNot)
    assert isinstance(other, statehtn.WhyNot)
    assert same.more == pytest.approx(0)
    assert "no plan is better" in str(same)
    assert other.more == pytest.approx(2.370690344)
    costs = [(part.own_cost or 0) - (part.other_cost or 0) for part in other.differences]
    assert sum(costs) == pytest.approx(other.more)
    assert other.to_dict()["valid"] is True


@pytest.mark.usefixtures("files")
def test_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["why", "d.hddl", "unreachable.hddl"]) == 0
    assert "└── method 'm-deliver'" in capsys.readouterr().out
    assert main(["why", "d.hddl", "unreachable.hddl", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["status"] == "unsolvable"
    assert found["reason"]["because"][0]["name"] == "m-deliver"
    assert ["(road home port)"] in found["additions"]
    assert main(["why", "d.hddl", "forbidden.hddl", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["stuck"][0]["lacks"][0]["changed_by"] == 2
    Path("plan.txt").write_text("(drive van home shop)\n", encoding="utf-8")
    assert main(["why", "d.hddl", "solvable.hddl", "--plan", "plan.txt", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["valid"] is False


@pytest.mark.usefixtures("files")
def test_mistakes_and_limits(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["why", "d.hddl", "solvable.hddl", "--alpha", "1", "--attitude", "averse"]) == 2
    assert "to a given plan alone" in capsys.readouterr().err
    assert main(["why", "d.hddl", "nowhere.hddl"]) == 30
    assert main(["why", "d.hddl", "solvable.hddl", "--time-limit", "1e-9"]) == 20
    capsys.readouterr()
    assert main(["why", "d.hddl", "solvable.hddl", "--time-limit", "1e-9", "--json"]) == 20
    assert json.loads(capsys.readouterr().out)["status"] == "time-limit"


@pytest.mark.usefixtures("files")
def test_plan_says_it_in_three_lines(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", "d.hddl", "unreachable.hddl"]) == 10
    first, second, third = capsys.readouterr().out.splitlines()[-3:]
    assert first == "why: (deliver box port): its only method cannot be used, even if nothing were ever deleted"
    assert second.startswith("at the root: (drive van ?a port): needs (road ?a port)")
    assert third == "'statehtn why' with the same files says more"
    assert main(["plan", "d.hddl", "unreachable.hddl", "--quiet"]) == 10
    assert main(["plan", "d.hddl", "forbidden.hddl", "--json"]) == 10
    assert "why" not in capsys.readouterr().out
