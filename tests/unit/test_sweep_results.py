"""Sweeps over alpha on known problems: the attitude map, the entropic value at risk, limits, and what is refused."""

from __future__ import annotations

import functools
import itertools
import json
import math
import time
from collections.abc import Callable, Iterator
from fractions import Fraction

import pytest

import statehtn
from statehtn import CostDistribution, Planner, Problem, Progress, Status
from statehtn.cli import main
from statehtn.model.cost.sum import CostSum
from statehtn.sweeps.minorants import certainty_equivalent, minorant
from statehtn.sweeps.plan_curve import PlanCurve
from tests.brute_force import all_plans
from tests.pages import ROOT

DOMAINS = ROOT / "domains"
LEVELS = (0.05, 0.5, 0.9, 0.99)
SLOPES = (-math.inf, -2.0, -0.9, -0.3, -0.05, 0.0, 0.02, 0.1, 0.3, 0.5, 1.0, math.inf)


def read(domain: str, problem: str) -> Problem:
    return statehtn.read_hddl(DOMAINS / domain / "domain.hddl", DOMAINS / domain / f"{problem}.hddl")


@pytest.fixture(scope="module")
def p1() -> Problem:
    return read("av", "p1")


@pytest.fixture(scope="module")
def curves(p1: Problem) -> list[PlanCurve]:
    """What each of the 16 plans of the vehicle's first problem is worth to everyone."""
    plans = all_plans(p1)
    assert len(plans) == 16
    return [PlanCurve(statehtn.validate(p1, plan).costs) for plan in plans]


def test_the_map_of_the_vehicle_has_the_best_of_all_plans(p1: Problem, curves: list[PlanCurve]) -> None:
    found = statehtn.attitude_map(p1, -math.inf, math.inf)
    assert (found.status, found.stopped) == (Status.OPTIMAL, None)
    assert [piece.expected_cost for piece in found.pieces] == pytest.approx([22.8, 18.35, 18.35, 19.4])
    for point, at in zip(found.breaks, (-0.480152, 0, 0.384175), strict=True):  # at 0 two plans have the same mean
        assert point.low <= point.high <= point.low + 1e-6
        assert point.low == pytest.approx(at, abs=1e-6)
    assert found.gap is not None
    assert found.eps is not None
    assert found.gap == 0  # all plans are known
    assert found.eps == pytest.approx(1e-3 * (19.4 - 5.5))
    for slope in SLOPES:
        best = min(curve.at(slope) for curve in curves)
        assert best - 1e-9 <= found.at(slope).certainty_equivalent(slope) <= best + found.at(slope).gap + 1e-9
    assert found.runs < 150


def test_break_points_hold_the_crossings_of_the_best_plans(p1: Problem, curves: list[PlanCurve]) -> None:
    found = statehtn.attitude_map(p1, 0.1, 1, resolution=1e-6)
    (point,) = found.breaks
    assert point.high - point.low <= 1e-6
    for slope, piece in ((point.low, found.pieces[0]), (point.high, found.pieces[1])):
        assert piece.certainty_equivalent(slope) == pytest.approx(min(curve.at(slope) for curve in curves), rel=1e-9)


@pytest.mark.parametrize("level", LEVELS)
def test_evar_is_the_least_of_all_plans(p1: Problem, level: float) -> None:
    values = [statehtn.objective(f"evar {level}").value(sum_of(p1, plan)) for plan in all_plans(p1)]
    result = statehtn.plan(p1, objective=f"evar {level}", precision=1e-9)
    assert result.status is Status.OPTIMAL
    assert result.value == pytest.approx(min(values), rel=1e-9)
    assert result.risk_cost == result.value
    assert result.gap is not None
    assert result.gap <= 1e-9 * result.value
    assert statehtn.plan(p1, objective=f"evar {level}", solver="plan").value == pytest.approx(result.value, rel=1e-6)


def sum_of(problem: Problem, plan: statehtn.Plan) -> CostSum:
    return CostSum(tuple(statehtn.validate(problem, plan).costs))


def test_evar_beside_budgets_and_of_several_plans(p1: Problem) -> None:
    laws = [sum_of(p1, plan) for plan in all_plans(p1)]
    values = sorted(law.evar(0.5) for law in laws)
    best = statehtn.top_plans(p1, 20, objective="evar 0.5")
    assert best.is_all
    assert [ranked.value for ranked in best] == pytest.approx(values, abs=1e-6)
    kept = [law.evar(0.5) for law in laws if law.cdf(16) >= 0.15]  # which leaves out the certain plan
    assert len(kept) < len(laws)
    result = statehtn.plan(p1, objective="evar 0.5", keep="16 0.15")
    assert result.status is statehtn.Status.OPTIMAL
    assert result.value == pytest.approx(min(kept), abs=1e-6)


@pytest.mark.parametrize("problem", [("marine", "p1"), ("satellite", "RA-3obs-1sat-3mod-unordered"), ("av", "p5")])
def test_evar_of_larger_problems_is_proven_in_few_runs(problem: tuple[str, str]) -> None:
    planner = Planner(read(*problem))
    below = planner.plan().value
    assert below is not None
    for level in LEVELS:
        result = planner.plan(objective=f"evar {level}", precision=1e-9)
        assert result.status is Status.OPTIMAL
        assert result.value is not None
        assert below <= result.value * (1 + 1e-12)
        below = result.value


def test_anytime_yields_better_and_better_plans(p1: Problem) -> None:
    results = list(statehtn.improving(p1, objective="evar 0.05"))
    values = [result.value for result in results if result.value is not None]
    assert values == sorted(values, reverse=True)
    assert [result.status for result in results] == [Status.SOLVED] * (len(results) - 1) + [Status.OPTIMAL]


def test_greedy_search_tells_the_value_of_what_it_finds(p1: Problem) -> None:
    result = statehtn.plan(p1, objective="evar 0.5", search="greedy")
    assert result.status is Status.SOLVED
    assert result.plan is not None
    assert result.value == pytest.approx(sum_of(p1, result.plan).evar(0.5))
    with pytest.raises(statehtn.UsageError, match="weighted search"):
        statehtn.plan(p1, objective="evar 0.5", search="weighted")  # its bound means nothing here


@pytest.mark.parametrize("seconds", [1e-6, 0.3, 1.0])
def test_a_limit_leaves_what_is_known(seconds: float) -> None:
    planner = Planner(read("av", "p9"))
    planner.plan(search="greedy")  # grounds
    start = time.monotonic()
    found = planner.attitude_map(-1, 1, time_limit=seconds)
    assert time.monotonic() - start < seconds + 10
    assert found.stopped is Status.TIME_LIMIT
    if found.pieces:
        assert found.status is Status.SOLVED
        assert (found.pieces[0].low, found.pieces[-1].high) == (-1, 1)
        assert "the sweep was ended before it was done: time-limit" in str(found)
        worst = found.pieces[-1].certainty_equivalent(1)
        assert found.gap is not None
        assert worst - found.pieces[-1].gap <= 1e9
    else:
        assert found.status is Status.TIME_LIMIT
        assert repr(found) == str(found) == "<attitude map from -1 to 1: time-limit, no plan>"
    result = planner.plan(objective="evar 0.9", time_limit=seconds)
    assert result.stopped is Status.TIME_LIMIT or result.status is Status.OPTIMAL
    if result.value is not None and result.lower_bound is not None:
        assert result.lower_bound <= 180.67
        assert result.value >= 180.66


def test_an_interruption_ends_a_sweep_with_what_is_known() -> None:
    def interrupt(_: Progress) -> None:
        raise KeyboardInterrupt

    result = statehtn.plan(read("av", "p9"), objective="evar 0.9", progress=interrupt)
    assert result.stopped is Status.INTERRUPTED
    with pytest.raises(KeyboardInterrupt) as caught:
        statehtn.attitude_map(read("av", "p9"), -1, 1, progress=interrupt, interrupt="raise")
    assert isinstance(caught.value.args[0], statehtn.AttitudeMap)
    assert caught.value.args[0].stopped is Status.INTERRUPTED


def test_an_interruption_between_two_runs_loses_nothing(p1: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    """As a Ctrl-C does that comes while a plan is valued."""
    for after in range(1, 30, 4):
        calls = itertools.count(1)

        def at(curve: PlanCurve, slope: float, *, after: int = after, calls: Iterator[int] = calls) -> float:
            if next(calls) == after:
                raise KeyboardInterrupt
            return curve._at(slope)

        with monkeypatch.context() as patched:
            patched.setattr(PlanCurve, "at", at)
            found = statehtn.attitude_map(p1, -1, 1)
        assert (found.status, found.stopped) == (Status.SOLVED, Status.INTERRUPTED)
        assert (found.pieces[0].low, found.pieces[-1].high) == (-1, 1)
        with monkeypatch.context() as patched:
            calls = itertools.count(1)
            patched.setattr(PlanCurve, "at", functools.partialmethod(at, calls=calls, after=after))
            result = statehtn.plan(p1, objective="evar 0.05")
        assert result.stopped in (None, Status.INTERRUPTED)
        assert result.status in (Status.OPTIMAL, Status.SOLVED, Status.INTERRUPTED)
        assert result.lower_bound is None or result.lower_bound <= 19.0570403


def test_progress_tells_of_the_whole_sweep() -> None:
    told: list[Progress] = []
    statehtn.plan(read("av", "p9"), objective="evar 0.9", progress=told.append)
    seconds = [progress.seconds for progress in told]
    assert seconds == sorted(seconds)
    assert [progress.expanded for progress in told] == sorted(progress.expanded for progress in told)
    assert all(progress.lower_bound is None or 160 < progress.lower_bound < 181 for progress in told)
    assert all(progress.best is None or 180 < progress.best < 182 for progress in told)


def unsolvable() -> Problem:
    return statehtn.read_hddl_text(
        "(define (domain d) (:predicates (p)) (:task t) (:method m :task (t) :precondition (p) :subtasks (and)))",
        "(define (problem q) (:domain d) (:htn :subtasks (and (t))) (:init))",
    )


@pytest.mark.filterwarnings("ignore:.*there is no plan")
def test_without_a_plan_there_is_no_map() -> None:
    found = statehtn.attitude_map(unsolvable(), -1, 1)
    assert (found.status, len(found), found.gap, found.eps, found.runs) == (Status.UNSOLVABLE, 0, None, None, 1)
    with pytest.raises(statehtn.UsageError, match="alpha 0 is not on the map"):
        found.at(0)
    assert statehtn.plan(unsolvable(), objective="evar 0.5").status is Status.UNSOLVABLE
    json.dumps(found.to_dict(), allow_nan=False)


def test_what_is_wrong_is_said(p1: Problem) -> None:
    wrong: list[tuple[float, float, dict[str, float], str]] = [
        (1, -1, {}, "the lower alpha must be below the upper one, found 1 and -1"),
        (math.nan, 1, {}, "the lower alpha must be a number, found nan"),
        (0, 1, {"eps": 0}, "eps must be a positive finite number, found 0"),
        (0, 1, {"resolution": -1}, "the resolution must be a positive finite number, found -1"),
    ]
    for low, high, options, message in wrong:
        with pytest.raises(statehtn.UsageError, match=message):
            statehtn.attitude_map(p1, low, high, **options)


def test_maps_are_data_and_are_shown(p1: Problem) -> None:
    found = statehtn.attitude_map(p1, -math.inf, 1, eps=0.5)
    data = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert (data["alpha_from"], data["alpha_to"], data["status"], data["eps"]) == (None, 1, "optimal", 0.5)
    assert [len(row["plan"]) for row in data["intervals"]] == [piece.found.length for piece in found.pieces]
    assert data["intervals"][1:] == found[1:]
    assert found[:2] == [found[0], found[1]]
    assert (found[0]["alpha_from"], found[0]["alpha_to"]) == (-math.inf, found.pieces[0].high)
    assert found[0]["plan"][0] == "(start)"
    assert repr(found.pieces[0]).startswith("<alpha from -inf to -0.4")
    assert "alpha from" in found._repr_html_()


def test_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    files = [str(DOMAINS / "av" / name) for name in ("domain.hddl", "p1.hddl")]
    assert main(["plan", *files, "--objective", "evar 0.05", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["status"], told["heuristic"], told["objective"]) == ("optimal", "auto", "evar 0.05")
    assert told["value"] == pytest.approx(19.0570402643)
    assert told["gap"] <= 1e-6 * told["value"]


def test_continuous_costs_and_heavy_tails(p1: Problem) -> None:
    """Where `E[e^(alpha C)]` is infinite from some alpha on, evar is finite all the same, and proven."""
    stats = pytest.importorskip("scipy.stats")
    smooth = statehtn.with_cost(p1, "brake", stats.gamma(2, scale=2.0))
    result = statehtn.plan(smooth, objective="evar 0.5")
    assert result.status is Status.OPTIMAL
    values = [sum_of(smooth, plan).evar(0.5) for plan in all_plans(smooth)]
    assert result.value == pytest.approx(min(values), rel=1e-6)
    with pytest.raises(statehtn.InputError, match="infinite"):
        statehtn.plan(statehtn.with_cost(p1, "brake", stats.lognorm(0.5)), objective="evar 0.5")
    with pytest.raises(statehtn.InputError, match="no worst case"):
        statehtn.attitude_map(smooth, 0, math.inf)
    found = statehtn.attitude_map(smooth, -0.3, 0.3)
    assert found.status is Status.OPTIMAL


LAWS: dict[str, Callable[[], statehtn.CostLaw]] = {
    "gamma": lambda: CostDistribution.from_scipy(__import__("scipy.stats").stats.gamma(2, scale=3)),
    "uniform": lambda: CostDistribution.from_scipy(__import__("scipy.stats").stats.uniform(1, 5)),
    "sum": lambda: CostSum((CostDistribution.of([(0.5, 1), (0.5, 4)]), CostDistribution.of([(0.9, 0), (0.1, 30)]))),
}


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize(("low", "high"), [(0.0, 5.0), (2.9, 3.1), (0.0, 1.0), (4.0, 40.0), (20.0, 21.0)])
def test_minorants_of_other_laws_are_below(name: str, low: float, high: float) -> None:
    pytest.importorskip("scipy.stats")
    law = LAWS[name]()
    at_low, at_high = minorant(law, low, high, (low + high) / 2)
    assert at_low >= at_high >= 0
    for share in (0, 0.25, 0.5, 0.75, 1):
        x = low + share * (high - low)
        try:
            truth = certainty_equivalent(law, x)
        except statehtn.InputError:
            truth = math.inf
        assert at_low + share * (at_high - at_low) <= truth * (1 + 1e-12)


def test_curves_of_plans() -> None:
    law = CostDistribution.of([(0.5, 1), (0.5, 4)])
    curve = PlanCurve([law, law, CostDistribution.certain(2)])
    assert curve == PlanCurve([CostSum((law, CostDistribution.certain(2))), law])
    assert len({curve, PlanCurve([law, law, CostDistribution.certain(2)])}) == 1
    assert [curve.at(slope) for slope in (-math.inf, 0.0, math.inf)] == [4, 7, 10]
    values = [curve.at(slope) for slope in SLOPES]
    assert values == sorted(values)
    for first, second in itertools.pairwise((0.0, 0.01, 0.3, 1.0, 2.0, 10.0)):
        assert curve.evar(first + 1e-9)[0] <= curve.evar(second)[0]
    value, x = curve.evar(0.5)
    assert value == pytest.approx(CostSum((law, law, CostDistribution.certain(2))).evar(-math.expm1(-0.5)), rel=1e-12)
    assert value == pytest.approx(curve.at(1 / x) + 0.5 * x)
    assert float(Fraction(4)) == PlanCurve([CostDistribution.certain(4)]).evar(1.0)[0]


def test_correlated_costs_have_no_map() -> None:
    domain = """
(define (domain road) (:predicates (snow)) (:functions (total-cost) - number) (:task trip)
  (:method go :task (trip) :subtasks (and (drive) (drive)))
  (:action drive :effect (when (snow) (increase (total-cost) 3))))"""
    text = (
        "(define (problem q) (:domain road) (:htn :subtasks (and (trip))) (:init (probabilistic 0.3 (snow) 0.7 (and))))"
    )
    problem = statehtn.read_hddl_text(domain, text)
    assert problem.scenarios
    with pytest.raises(statehtn.UnsupportedError, match="costs that depend on hidden facts hang together"):
        statehtn.attitude_map(problem, -1, 1)
