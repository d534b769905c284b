"""The atlas of a problem: its data, against all plans; its page; and what the command says."""

from __future__ import annotations

import itertools
import json
import math
from dataclasses import replace
from pathlib import Path

import numpy
import pytest

import statehtn
from statehtn.atlas.between import all_deadlines, all_wealths
from statehtn.cli import main
from statehtn.display.atlas.alpha_axis import AlphaAxis, words
from statehtn.model import CostDistribution, CostLaw, Problem
from statehtn.model.status import Status
from tests.brute_force import all_plans

DOMAINS = Path(__file__).parents[2] / "domains"
AV = [str(DOMAINS / "av" / "domain.hddl"), str(DOMAINS / "av" / "p1.hddl")]
ALPHAS = 10_000
UNSOLVABLE = (
    "(define (domain d) (:predicates (p)) (:task t) (:method m :task (t) :precondition (p) :subtasks (and)))",
    "(define (problem q) (:domain d) (:htn :subtasks (and (t))) (:init))",
)


@pytest.fixture(scope="module")
def p1() -> Problem:
    return statehtn.read_hddl(*AV)


@pytest.fixture(scope="module")
def atlas(p1: Problem) -> statehtn.Atlas:
    return statehtn.survey(p1)


def equivalents(laws: list[CostLaw], alphas: numpy.ndarray) -> numpy.ndarray:
    """Certainty equivalents of a sum of finite laws at alphas that are not 0, by the definition."""
    total = numpy.zeros_like(alphas)
    for law in laws:
        assert isinstance(law, CostDistribution)
        chances = numpy.array([chance for chance, _ in law.outcomes])
        costs = numpy.array([cost for _, cost in law.outcomes])
        exponents = numpy.outer(alphas, costs)
        most = exponents.max(axis=1)
        total += (most + numpy.log(numpy.exp(exponents - most[:, None]) @ chances)) / alphas
    return total


def test_the_map_names_the_best_of_all_plans_at_ten_thousand_alphas(p1: Problem, atlas: statehtn.Atlas) -> None:
    plans = {tuple(str(step) for step in plan.steps): list(statehtn.validate(p1, plan).costs) for plan in all_plans(p1)}
    sizes = numpy.geomspace(1e-4, 60, ALPHAS // 2)
    alphas = numpy.concatenate((-sizes[::-1], sizes))
    worth = {steps: equivalents(laws, alphas) for steps, laws in plans.items()}
    best = numpy.min(list(worth.values()), axis=0)
    rows = list(atlas.map)
    asked = 0
    for index, alpha in enumerate(alphas):
        if any(one.low <= alpha <= one.high for one in atlas.map.breaks):
            continue
        (row,) = (row for row in rows if row["alpha_from"] < alpha < row["alpha_to"])
        asked += 1
        assert worth[tuple(row["plan"])][index] <= best[index] + 1e-9
    assert asked >= ALPHAS - 10
    assert all(one.high - one.low < 1e-6 for one in atlas.map.breaks)
    for (left, right), point in zip(itertools.pairwise(rows), atlas.map.breaks, strict=True):
        ends = numpy.array([point.low, point.high])
        gain = (
            equivalents(plans[tuple(left["plan"])], ends) - equivalents(plans[tuple(right["plan"])], ends)
            if abs(point.low) > 1e-9
            else numpy.array([0.0, 0.0])
        )
        assert gain[0] <= 1e-12
        assert gain[1] >= -1e-12


def test_everything_of_a_small_problem_is_proven(atlas: statehtn.Atlas) -> None:
    assert (atlas.status, atlas.map.gap, len(atlas.map)) == (Status.OPTIMAL, 0, 4)
    assert [plan.name for plan in atlas.plans[:4]] == ["A", "B", "C", "D"]
    assert atlas.of_piece == [0, 1, 2, 3]
    assert [one.status for one in atlas.frontiers] == [Status.OPTIMAL] * 3
    for choices, form in ((atlas.deadlines, "deadline {}"), (atlas.wealths, "one-switch {}")):
        assert len(choices) > 10
        assert [choice.at for choice in choices] == sorted(choice.at for choice in choices)
        assert all(choice.plan is not None and choice.gap is not None and choice.gap <= 1e-6 for choice in choices), (
            form
        )
    late = [choice.value for choice in atlas.deadlines]
    assert late == sorted(late, reverse=True)
    data = json.loads(json.dumps(atlas.to_dict(), allow_nan=False))
    assert data["map"]["intervals"][0]["alpha_from"] is None
    assert data["plans"][data["plan_of_interval"][3]]["mean"] == pytest.approx(19.4)
    assert repr(atlas).startswith("<atlas of 'p1': <attitude map from -inf to inf: optimal, 4 plans")


def test_what_is_said_between_answers_is_true(p1: Problem, atlas: statehtn.Atlas) -> None:
    plans = [plan.with_costs(statehtn.validate(p1, plan).costs).cost_distribution() for plan in all_plans(p1)]
    alpha, tradeoff = atlas.one_switch
    cases = (
        (all_deadlines(atlas, 3), atlas.deadlines, statehtn.Deadline),
        (all_wealths(atlas, 3), atlas.wealths, lambda at: statehtn.OneSwitch(alpha, tradeoff, at)),
    )
    for known, asked, objective in cases:
        assert len(known) == 4 * (len(asked) - 1) + 1
        assert [choice.at for choice in known] == sorted(choice.at for choice in known)
        assert [choice for choice in known if choice in asked] == asked
        for choice in known:
            wanted = objective(choice.at)
            best = min(wanted.value(law) for law in plans)
            assert choice.plan is not None
            assert choice.value is not None
            assert choice.gap is not None
            assert choice.value == pytest.approx(wanted.value(atlas.plans[choice.plan].total), rel=1e-9, abs=1e-12)
            assert choice.value - choice.gap - 1e-9 <= best <= choice.value + 1e-9
    proven = [choice for choice in all_wealths(atlas, 3) if (choice.gap or 0) <= 1e-5]
    assert len(proven) > 3 * len(atlas.wealths)  # where one plan is the best on both sides, it is between them


def test_between_answers_without_a_proof_nothing_is_claimed(atlas: statehtn.Atlas) -> None:
    worse = [replace(choice, gap=None) for choice in atlas.deadlines]
    known = all_deadlines(replace(atlas, deadlines=worse), 1)
    assert all(choice.gap is None for choice in known)
    loose = [replace(choice, gap=0.25) for choice in atlas.deadlines]
    for choice in all_deadlines(replace(atlas, deadlines=loose), 1):
        assert choice.gap is not None
        assert choice.gap >= 0.25 or choice.value - choice.gap <= 0 or choice.at in {one.at for one in loose}


def test_maps_and_frontiers_are_rows(atlas: statehtn.Atlas) -> None:
    for row in atlas.map:
        assert type(row) is dict
        assert list(row) == ["alpha_from", "alpha_to", "plan", "length", "expected_cost", "gap"]
    assert [list(row) for row in atlas.frontiers[0]] == [["mean", "risk", "plan"]] * len(atlas.frontiers[0].points)


def test_the_page_has_every_plan_and_needs_nothing_else(atlas: statehtn.Atlas) -> None:
    pytest.importorskip("jinja2")
    pytest.importorskip("matplotlib")
    page = atlas.to_html()
    assert page.count('class="card"') == len(atlas.plans)
    assert "The map and the frontiers are proven" in page
    assert "://" not in page.replace("http://www.w3.org/2000/svg", "")
    assert len(page.encode()) < 2_000_000


def test_the_command_writes_the_page_or_its_data(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("jinja2")
    pytest.importorskip("matplotlib")
    page = tmp_path / "atlas.html"
    options = ["--alpha-from", "0.1", "--alpha-to", "1"]
    assert main(["atlas", *AV, *options, "--output", str(page)]) == 0
    assert "the map is optimal" in capsys.readouterr().out
    assert page.read_text().endswith("</html>")
    assert main(["atlas", *AV, *options, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert (data["map"]["alpha_from"], data["map"]["alpha_to"]) == (0.1, 1)
    assert len(data["map"]["intervals"]) == 2


def test_what_goes_wrong_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["atlas", *AV]) == 2
    assert "write the page with --output FILE.html, or print its data with --json" in capsys.readouterr().err
    assert main(["atlas", *AV, "--alpha-from", "1", "--alpha-to", "0", "--json"]) == 2
    assert "the lower alpha must be below the upper one" in capsys.readouterr().err
    files = [tmp_path / "domain.hddl", tmp_path / "problem.hddl"]
    for file, text in zip(files, UNSOLVABLE, strict=True):
        file.write_text(text)
    assert main(["atlas", *map(str, files), "--json"]) == 10
    assert json.loads(capsys.readouterr().out)["map"]["intervals"] == []


def test_a_limit_leaves_what_is_known_and_says_what_is_open() -> None:
    p9 = statehtn.read_hddl(DOMAINS / "av" / "domain.hddl", DOMAINS / "av" / "p9.hddl")
    found = statehtn.survey(p9, time_limit=1.0)
    assert found.status in (Status.SOLVED, Status.TIME_LIMIT)
    if found.map.pieces:
        assert found.map.gap is not None
        assert found.map.gap > 0
        pytest.importorskip("jinja2")
        pytest.importorskip("matplotlib")
        assert "The map is not certified everywhere" in found.to_html()


def test_a_map_of_seeking_agents_alone(p1: Problem) -> None:
    found = statehtn.survey(p1, -2, -0.1)
    assert found.mildest == found.of_piece[-1]
    assert [one.status for one in found.frontiers] == [Status.OPTIMAL] * 3
    pytest.importorskip("jinja2")
    pytest.importorskip("matplotlib")
    assert found.to_html().count('class="card"') == len(found.plans)


def test_the_axis_reaches_both_ends_and_comes_back(atlas: statehtn.Atlas) -> None:
    axis = AlphaAxis.of(atlas.map)
    places = axis.places(21)
    assert (places[0], places[10], places[-1]) == (-1, 0, 1)
    assert [axis.place(axis.alpha(place)) for place in places] == pytest.approx(places)
    ticks = axis.ticks()
    assert [label for _, label in ticks][:: len(ticks) - 1] == ["\N{MINUS SIGN}\N{INFINITY}", "\N{INFINITY}"]
    assert all(right - left >= 0.089 for (left, _), (right, _) in itertools.pairwise(ticks))
    assert (words(-0.5), words(math.inf)) == ("\N{MINUS SIGN}0.5", "\N{INFINITY}")
