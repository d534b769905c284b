"""`statehtn policy`, and `statehtn plan` where a problem needs a policy."""

from __future__ import annotations

import json
import math
from pathlib import Path
from unittest import mock

import pytest

import statehtn
from statehtn import CostDistribution, Status
from statehtn.cli.program import main
from statehtn.limits import LimitReached
from statehtn.policies.evar import EvarSearch

GRIPPER = ("domains/gripper-robot/domain.hddl", "domains/gripper-robot/p1.hddl")
VEHICLE = ("domains/av/domain.hddl", "domains/av/p1.hddl")
TREE = [
    "A: (suck ball)  cost 1",
    "  if (in-hand ball) and not (hand-empty) and not (on-belt ball), 0.5:",
    "    (place ball)  cost 3",
    "    done",
    "  otherwise, 0.5: go on at A",
]


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    code = main(arguments)
    shown = capsys.readouterr()
    return code, shown.out, shown.err


@pytest.mark.parametrize("command", ["policy", "plan"])
def test_the_tree(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, command, *GRIPPER, "--quiet")
    assert code == 0
    assert out.splitlines() == TREE


@pytest.mark.parametrize("command", ["policy", "plan"])
def test_the_object(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, command, *GRIPPER, "--json", "--precision", "1e-10")
    found = json.loads(out)
    assert code == 0
    assert (found["status"], found["problem_class"], found["objective"]) == ("optimal", "PSn0011", "neutral")
    assert found["value"] == pytest.approx(5, abs=1e-9)
    assert (found["success_probability"], found["reason"], found["stopped"]) == (1, None, None)
    assert found["lower_bound"] <= found["value"] <= found["upper_bound"]
    assert found["policy"]["nodes"][0]["decision"]["branches"]
    assert "decompositions" in found["validated"]


def test_averse_agents(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, "policy", *GRIPPER, "--json", "--attitude", "averse", "--alpha", "0.3")
    e = math.exp(0.3)
    assert code == 0
    assert json.loads(out)["value"] == pytest.approx(3 + math.log(0.5 * e / (1 - 0.5 * e)) / 0.3, abs=1e-9)
    code, out, _ = run(capsys, "policy", *GRIPPER, "--json", "--attitude", "averse", "--alpha", "0.7")
    found = json.loads(out)
    assert (code, found["status"], found["value"], found["policy"]) == (10, "unsolvable", None, None)
    assert "0.7" in found["reason"]


def test_giving_up(capsys: pytest.CaptureFixture[str]) -> None:
    """To give up at once costs less than what is to be expected."""
    code, out, _ = run(capsys, "policy", *GRIPPER, "--json", "--failure-cost", "4")
    found = json.loads(out)
    assert code == 0
    assert (found["value"], found["success_probability"], found["failure_cost"]) == (4, 0, 4)


def test_looking_is_worth_something_before_a_deadline(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, "policy", *VEHICLE, "--json", "--objective", "deadline 18", "--adaptive")
    found = json.loads(out)
    assert code == 0
    assert found["looking"]["worth"] == pytest.approx(found["looking"]["plan_value"] - found["value"], abs=1e-12)
    assert found["looking"]["worth"] >= -1e-9
    plan = statehtn.plan(statehtn.read_hddl(*VEHICLE), objective="deadline 18")
    assert found["looking"]["plan_value"] == pytest.approx(plan.value, abs=1e-9)


@pytest.mark.parametrize("objective", ["neutral", "averse 0.3", "seeking 0.3"])
def test_looking_is_worth_nothing_to_exponential_agents(objective: str) -> None:
    problem = statehtn.read_hddl(*VEHICLE)
    result = statehtn.policy(problem, objective=objective, adaptive=True)
    assert result.status is Status.OPTIMAL
    assert result.value == pytest.approx(statehtn.plan(problem, objective=objective).value, rel=1e-9)
    assert "is worth nothing" in str(result)


def test_pictures(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pydot")
    file = tmp_path / "policy.dot"
    code, _, _ = run(capsys, "policy", *GRIPPER, "--dot", str(file), "--quiet")
    text = file.read_text(encoding="utf-8")
    assert code == 0
    assert "(suck ball)" in text
    assert "otherwise" in text


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (["--objective", "mean-variance 1"], 31, "no policy can be found by 'mean-variance 1'"),
        (["--objective", "mean-deviation 1"], 31, "no policy can be found by 'mean-deviation 1'"),
        (["--objective", "success-utility alpha=1"], 31, "counts on one outcome of each action"),
        (["--failure-cost", "-1"], 2, "at least 0"),
        (["--failure-cost", "much"], 2, "argument --failure-cost: expected a number, found 'much'"),
        (["--failure-cost", "inf"], 2, "'deadline' and 'quantile' only"),
        (["--objective", "success", "--failure-cost", "3"], 2, "failing has no cost"),
        (["--adaptive"], 2, "several outcomes"),
        (["--objective", "success", "--alpha", "1"], 2, "leave out --alpha"),
    ],
)
def test_what_has_no_policies(options: list[str], code: int, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    found, out, err = run(capsys, "policy", *GRIPPER, *options)
    assert (found, out) == (code, "")
    assert message in err
    assert err.count("\n") == 1


def test_options_of_plans_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    code, _, err = run(capsys, "plan", *GRIPPER, "--search", "greedy")
    assert code == 2
    assert "--search is for plans" in err


def test_plans_from_python_are_refused() -> None:
    with pytest.raises(statehtn.UnsupportedError, match="statehtn.policy"):
        statehtn.plan(statehtn.read_hddl(*GRIPPER))


def test_a_time_limit(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, "policy", *GRIPPER, "--json", "--time-limit", "1e-9")
    assert (code, json.loads(out)["status"]) == (20, "time-limit")


def test_counting_on_an_outcome() -> None:
    """The plan holds the ball at the first try, which comes with probability 1/2."""
    result = statehtn.plan(statehtn.read_hddl(*GRIPPER), objective="success-utility alpha=0.1")
    assert result.status is Status.OPTIMAL
    assert result.validated
    assert [str(step.step) for step in result.steps] == ["(suck ball)", "(place ball)"]
    assert [step.probability for step in result.steps] == [0.5, 1]
    assert result.value == pytest.approx(-math.log(0.5 * math.exp(-0.1 * 4)), rel=1e-9)
    assert result.problem_class == "PSn0112"


def test_a_fixed_sequence() -> None:
    """Two tries and placing fail where the first try holds, since the second cannot be executed then."""
    problem = statehtn.read_hddl(*GRIPPER)
    steps = [statehtn.Step("suck", ("ball",)), statehtn.Step("place", ("ball",))]
    law = statehtn.sequence_cost(problem, steps, failure_cost=10)
    assert law.failed == pytest.approx(0.5)
    assert law.outcomes == ((0.5, 4), (0.5, 11))
    twice = statehtn.sequence_cost(problem, ["(suck ball)", "(Suck ball)", steps[1]])
    assert twice.failed == pytest.approx(0.75)
    for wrong, words in (
        ("(suck bal)", "there is no object 'bal'"),
        ("(suck)", "expected 1 arguments, found 0"),
        ("(pull ball)", "no such action"),
    ):
        with pytest.raises(statehtn.UsageError, match=words):
            statehtn.sequence_cost(problem, [wrong])


def test_a_policy_is_asked() -> None:
    result = statehtn.policy(statehtn.read_hddl(*GRIPPER))
    policy = result.policy
    assert policy is not None
    start = policy.start
    decision = policy.decide(result.policy.problem.initial_state, policy.network_of(start))
    assert decision == start.decision
    run = policy.trajectory(seed=1)
    assert [taken.step.action for taken in run.steps][-1] == "place"
    assert "pack" in str(policy.decomposition(run))
    with pytest.raises(statehtn.UsageError, match="never gets there|no run of this policy"):
        policy.decide([("torn",)], policy.network_of(start))
    with pytest.raises(statehtn.UsageError, match="a network is a pair of tasks and their order"):
        policy.decide([("torn",)], ())  # type: ignore[arg-type]
    for spent in (-1, math.nan):
        with pytest.raises(statehtn.UsageError, match="what was spent must be at least 0"):
            policy.decide([("torn",)], policy.network_of(start), spent)


def test_a_run_that_may_end_late_has_an_infinite_value_at_risk() -> None:
    law = CostDistribution.of([(0.5, 1), (0.5, 3)])
    assert statehtn.objective("evar 0.1").value(law) < 3
    late = statehtn.policy(statehtn.read_hddl(*GRIPPER), objective="deadline 5", failure_cost=math.inf)
    law_with_failures = late.policy.cost_distribution()
    assert math.isinf(law_with_failures.mean)
    assert statehtn.objective("evar 0.5").value(law_with_failures) == math.inf


def test_the_entropic_value_at_risk() -> None:
    """The claw never holds here, so that there is one policy; its law says what it is worth."""
    result = statehtn.policy(statehtn.read_hddl(*GRIPPER), objective="evar 0.9")
    assert result.status is Status.OPTIMAL
    assert result.value == pytest.approx(result.policy.cost_distribution().evar(0.9), rel=1e-12)
    assert result.gap <= 1e-6 * result.value
    assert result.statistics.search.expanded < 100


def test_a_limit_leaves_the_policy_of_least_entropic_value_at_risk_so_far() -> None:
    """The neutral agent's policy comes first; what no policy can be below is its expected cost."""
    with mock.patch.object(EvarSearch, "_run_at", side_effect=LimitReached(Status.TIME_LIMIT)):
        result = statehtn.policy(statehtn.read_hddl(*GRIPPER), objective="evar 0.9")
    assert (result.status, result.stopped) == (Status.SOLVED, Status.TIME_LIMIT)
    assert result.value == pytest.approx(10.589009175621065)
    assert result.lower_bound == pytest.approx(5, rel=1e-6)
    assert result.gap == pytest.approx(result.value - result.lower_bound)


def test_results_show_themselves() -> None:
    result = statehtn.policy(statehtn.read_hddl(*GRIPPER), failure_cost=100)
    assert str(result).splitlines()[0] == "status: optimal (neutral)"
    assert "value: 5" in str(result)
    html = result._repr_html_()
    assert "(suck ball)" in html
    assert "status: optimal" in html
    assert "value 5" in repr(result)


def test_no_policy_says_why() -> None:
    """The rover may be stuck, so that no policy is done for certain; the best chance is said."""
    problem = statehtn.read_hddl("domains/exploring-rover/domain.hddl", "domains/exploring-rover/p3.hddl")
    result = statehtn.policy(problem)
    assert (result.status, result.policy, result.value) == (Status.UNSOLVABLE, None, None)
    assert "probability 1" in (result.reason or "")
    assert result.most_success == pytest.approx(0.9, abs=1e-6)
    likeliest = statehtn.policy(problem, objective="success")
    assert likeliest.value == pytest.approx(0.9, abs=1e-9)
    assert "give up" in str(likeliest)
    late = statehtn.policy(problem, objective="deadline 100", failure_cost=math.inf)
    assert late.value == pytest.approx(0.1, abs=1e-9)


def test_a_limit_leaves_a_policy_and_both_values() -> None:
    problem = statehtn.read_hddl("domains/gripper-robot/domain.hddl", "domains/gripper-robot/p4.hddl")
    result = statehtn.policy(problem, objective="cvar 0.9", time_limit=1.5)
    assert result.stopped in (None, Status.TIME_LIMIT)
    if result.policy is not None:
        assert result.lower_bound <= result.value + 1e-9
        assert result.upper_bound == pytest.approx(result.value)


@pytest.mark.parametrize("objective", ["neutral", "averse 0.1", "overrun 5", "evar 0.5", "cvar 0.9"])
def test_a_failure_cost_beside_which_costs_are_lost(objective: str, capsys: pytest.CaptureFixture[str]) -> None:
    """The largest expected cost is 9, of a try by the claw."""
    options = ("--objective", objective, "--failure-cost")
    for wrong in ("1e300", "9.1e9"):
        code, out, err = run(capsys, "policy", *GRIPPER, *options, wrong)
        assert (code, out) == (2, "")
        assert "take at most 9e+09, 10^9 times the largest expected cost of an action" in err
        assert err.count("\n") == 1


@pytest.mark.parametrize("failure_cost", [1e4, 1e7, 6e9])
def test_giving_up_is_not_the_best_because_of_rounding(failure_cost: float) -> None:
    """To try gains an averse agent about 20, however much failing costs."""
    problem = statehtn.read_hddl(GRIPPER[0], "domains/gripper-robot/p3.hddl")
    for objective in ("neutral", "averse 0.1"):
        result = statehtn.policy(problem, objective=objective, failure_cost=failure_cost)
        assert result.success_probability == pytest.approx(8 / 9)
    assert failure_cost - result.value == pytest.approx(19.7231663, abs=1e-4)


@pytest.mark.parametrize("objective", ["deadline 8", "quantile 0.5"])
def test_amounts_in_steps_are_exact(objective: str) -> None:
    problem = statehtn.read_hddl(*GRIPPER)
    values = {statehtn.policy(problem, objective=objective, failure_cost=cost).value for cost in (1e300, math.inf)}
    assert len(values) == 1
