"""Costs from side files: what they mean, and what is said about wrong ones."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

import statehtn
from statehtn.cli import main
from statehtn.core.grounding import ground
from statehtn.model import CostDistribution
from tests.pages import ROOT, blocks

AV = tuple(str(ROOT / "domains" / "av" / name) for name in ("domain.hddl", "p1.hddl"))

FREE = """
(define (domain d) (:types place) (:predicates (at ?p - place))
  (:task go :parameters (?p - place))
  (:method walk :parameters (?a ?b - place) :task (go ?b) :precondition (at ?a) :subtasks (step ?a ?b))
  (:method fly :parameters (?b - place) :task (go ?b) :ordered-subtasks (and (rise) (land ?b)))
  (:action step :parameters (?a ?b - place) :precondition (at ?a) :effect (and (at ?b) (not (at ?a))))
  (:action rise :parameters ()) (:action land :parameters (?b - place) :effect (at ?b)))
"""
START = "(define (problem p) (:domain d) (:objects x y z - place) (:htn :subtasks (and (go y) (go z))) (:init (at x)))"


@pytest.fixture(scope="module")
def vehicle() -> statehtn.Problem:
    return statehtn.read_hddl(*AV)


@pytest.fixture(scope="module")
def walk() -> statehtn.Problem:
    return statehtn.read_hddl_text(FREE, START)


def written(folder: Path, text: str, name: str = "costs.toml") -> Path:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def costs(problem: statehtn.Problem, action: str) -> dict[tuple[str, ...], str]:
    """The law of every ground instance of an action, as text."""
    return {item.arguments: str(item.cost) for item in ground(problem).to_model().actions if item.name == action}


def test_every_kind_of_law_is_what_with_cost_gives(tmp_path: Path, vehicle: statehtn.Problem) -> None:
    written(tmp_path, "3, 1\n1; 1\n", "seen.txt")
    cases: list[tuple[str, object]] = [
        ("cost = 0.3", 0.3),
        ("outcomes = [[0.8, 2], [0.2, 6.5]]", CostDistribution.of([(0.8, 2), (0.2, 6.5)])),
        ("samples = [3, 1, 1, 1]", CostDistribution.from_samples([3, 1, 1, 1])),
        ('samples = "seen.txt"', CostDistribution.from_samples([3, 1, 1, 1])),
        ("counts = [[17, 2], [3, 6]]", CostDistribution.from_counts({2: 17, 6: 3})),
        ("counts = [[17, 2], [3, 6]]\nprior = 0.5", CostDistribution.from_counts({2: 17, 6: 3}, 0.5)),
        ("counts = [[17, 2]]\nprior = [[1, 2], [0.1, 60]]", CostDistribution.from_counts({2: 17}, {2: 1, 60: 0.1})),
        ('distribution = "gamma"\nparameters = { a = 2, scale = 3 }', stats.gamma(2, scale=3)),
        ('distribution = "expon"', stats.expon()),
        ("pert = [2, 3, 9]", stats.beta(1 + 4 / 7, 5 - 4 / 7, loc=2, scale=7)),
        ("pert = [3, 3, 3]", 3),
        ('distribution = "randint"\nparameters = { low = 1, high = 4 }', stats.randint(1, 4)),
    ]
    for text, cost in cases:
        file = written(tmp_path, f'[[costs]]\naction = "Brake"\n{text}')
        assert statehtn.read_costs(file).apply(vehicle) == statehtn.with_cost(vehicle, "brake", cost), text


def test_json_and_toml_say_the_same(tmp_path: Path, vehicle: statehtn.Problem) -> None:
    entries = [
        {"action": "brake", "arguments": ["l1"], "outcomes": [[0.5, 1], [0.5, 2.5]]},
        {"action": "stop", "cost": 0.1},
    ]
    as_json = written(tmp_path, json.dumps({"costs": entries}), "costs.json")
    as_toml = written(
        tmp_path,
        '[[costs]]\naction = "brake"\narguments = ["l1"]\noutcomes = [[0.5, 1], [0.5, 2.5]]\n'
        '[[costs]]\naction = "stop"\ncost = 0.1\n',
    )
    assert statehtn.read_costs(as_json).apply(vehicle) == statehtn.read_costs(as_toml).apply(vehicle)


def test_the_first_entry_that_fits_counts(tmp_path: Path, walk: statehtn.Problem) -> None:
    file = written(
        tmp_path,
        """
        [[costs]]
        action = "step"
        arguments = ["x", "y"]
        cost = 5
        [[costs]]
        action = "step"
        arguments = ["*", "y"]
        cost = 6
        [[costs]]
        action = "step"
        arguments = ["y", "*"]
        outcomes = [[0.5, 0], [0.5, 2]]
        """,
    )
    problem = statehtn.read_costs(file).apply(walk)
    found = costs(problem, "step")
    assert found["x", "y"] == "5"
    assert found["z", "y"] == "6"
    assert found["y", "z"] == "0 w.p. 0.5, 2 w.p. 0.5"
    assert found["x", "z"] == "1"  # what has no entry keeps its cost, which is 1 in a domain without costs
    assert costs(problem, "rise") == {(): "1"}
    with pytest.warns(statehtn.HddlWarning, match="is an object of the problem"):
        again = statehtn.read_hddl_text(*statehtn.write_hddl(problem))
    assert costs(again, "step") == found


def test_own_costs_stay_where_no_entry_fits(tmp_path: Path, vehicle: statehtn.Problem) -> None:
    file = written(tmp_path, '[[costs]]\naction = "brake"\narguments = ["l5"]\ncost = 7\n')
    problem = statehtn.read_costs(file).apply(vehicle)
    before, after = costs(vehicle, "brake"), costs(problem, "brake")
    assert after == before | {("l5",): "7"}
    assert costs(problem, "accelerate") == costs(vehicle, "accelerate")
    plan = statehtn.plan(vehicle, attitude="seeking", alpha=0.9).plan
    assert plan is not None
    assert statehtn.validate(problem, plan).expected_cost == pytest.approx(22.8 - 2.3 + 7)


@settings(max_examples=25, deadline=None)
@given(
    st.lists(
        st.tuples(st.sampled_from("xyz*"), st.sampled_from("xyz*"), st.integers(0, 9)),
        max_size=6,
        unique_by=lambda e: e[:2],
    )
)
def test_entries_are_read_from_top_to_bottom(entries: list[tuple[str, str, int]]) -> None:
    """Random entries against the definition; those that could never count are refused."""
    from statehtn.build.cost_table import CostEntry, CostTable

    problem = statehtn.read_hddl_text(FREE, START)
    table = CostTable(
        tuple(
            CostEntry(f"entry {number}", "step", (a, b), CostDistribution.certain(cost))
            for number, (a, b, cost) in enumerate(entries)
        )
    )

    def fits(entry: tuple[str, str, int], arguments: tuple[str, ...]) -> bool:
        return all(pattern in ("*", name) for pattern, name in zip(entry[:2], arguments, strict=True))

    covered = any(
        all(pattern in ("*", name) for pattern, name in zip(earlier[:2], entry[:2], strict=True))
        for number, entry in enumerate(entries)
        for earlier in entries[:number]
    )
    if covered:
        with pytest.raises(statehtn.InputError, match="it never counts"):
            table.apply(problem)
        return
    for arguments, found in costs(table.apply(problem), "step").items():
        assert found == next((str(entry[2]) for entry in entries if fits(entry, arguments)), "1")


WRONG = [
    ("", "'costs': expected a list of tables"),
    ("[costs]\naction = 1", "'costs': expected a list of tables"),
    ("costs = [1]", "'costs': expected a list of tables"),
    ("cost = []", "unknown key 'cost'; there are costs"),
    ("[[costs]]", "entry 1 of 'costs': 'action' is missing"),
    ('[[costs]]\naction = "brake"', "entry 1 of 'costs': expected one of cost, outcomes, samples.*, found none"),
    ('[[costs]]\naction = "brake"\ncost = 1\nsamples = [1]', "found cost and samples"),
    ('[[costs]]\naction = "brake"\ncost = 1\nprior = 1', "unknown key 'prior'"),
    ('[[costs]]\naction = "brake"\ncost = "x"', "'cost': expected a number, found 'x'"),
    ('[[costs]]\naction = "brake"\ncost = true', "'cost': expected a number, found true"),
    ('[[costs]]\naction = "brake"\ncost = -1', "'cost': a cost must be a finite number and at least 0, found -1"),
    ('[[costs]]\naction = "brake"\ncost = ' + "9" * 400, "'cost': a number of 400 digits is too large"),
    ('[[costs]]\naction = "brake"\ncost = ' + "9" * 9000, "this is no TOML: Exceeds the limit"),
    ('[[costs]]\naction = "brake"\ncost = nan', "'cost': a cost must be a finite number"),
    ('[[costs]]\naction = "brake"\noutcomes = [1]', r"'outcomes': expected a list of pairs \[probability, cost\]"),
    ('[[costs]]\naction = "brake"\noutcomes = []', r"'outcomes': expected a list of pairs"),
    ('[[costs]]\naction = "brake"\noutcomes = [[0.5, 1]]', "'outcomes': the probabilities of a cost must sum to 1"),
    ('[[costs]]\naction = "brake"\nsamples = []', "'samples': a distribution from samples needs at least one"),
    ('[[costs]]\naction = "brake"\nsamples = "gone.txt"', "'samples': cannot read '.*gone.txt': No such file"),
    ('[[costs]]\naction = "brake"\nsamples = "costs.toml"', "'samples': expected numbers in '.*', found"),
    ('[[costs]]\naction = "brake"\ncounts = [[1, 2], [3, 2]]', "'counts': expected each cost once, found 2.0"),
    ('[[costs]]\naction = "brake"\ndistribution = "gama"', "'distribution': expected the name of a distribution"),
    ('[[costs]]\naction = "brake"\ndistribution = "gamma"', "'parameters': 'gamma' needs a"),
    ('[[costs]]\naction = "brake"\ndistribution = "gamma"\nparameters = { b = 1 }', "expected some of a, loc, scale"),
    ('[[costs]]\naction = "brake"\ndistribution = "gamma"\nparameters = { a = "1" }', "expected numbers, found '1'"),
    ('[[costs]]\naction = "brake"\ndistribution = "norm"', "'distribution': norm.* can be as low as -inf"),
    ('[[costs]]\naction = "brake"\narguments = "l1"\ncost = 1', "'arguments': expected a list of objects' names"),
    ('[[costs]]\naction = "break"\ncost = 1', "'action': .*'break'.*brake"),
    ('[[costs]]\naction = "brake"\narguments = []\ncost = 1', "'arguments': expected 1 for .*, found 0"),
    ('[[costs]]\naction = "brake"\narguments = ["l99"]\ncost = 1', "'arguments': .*'l99'"),
    (
        '[[costs]]\naction = "brake"\ncost = 1\n[[costs]]\naction = "brake"\narguments = ["l1"]\ncost = 2',
        "entry 2 of 'costs': it never counts, as entry 1 of 'costs' says the cost of the same instances before",
    ),
    ("[[costs", "this is no TOML"),
]


@pytest.mark.parametrize(("text", "message"), WRONG, ids=range(len(WRONG)))
def test_wrong_files(tmp_path: Path, vehicle: statehtn.Problem, text: str, message: str) -> None:
    file = written(tmp_path, text)
    with pytest.raises(statehtn.InputError, match=message) as error:
        statehtn.read_costs(file).apply(vehicle)
    assert str(error.value).startswith(str(file))


def test_the_page_shows_the_example() -> None:
    page = (ROOT / "docs" / "costs.md").read_text(encoding="utf-8")
    (shown,) = (block.text for block in blocks(page) if block.language == "toml")
    assert shown == (ROOT / "examples" / "av-costs.toml").read_text(encoding="utf-8")


def test_files_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(statehtn.InputError, match="cannot read '.*nothing.toml': No such file"):
        statehtn.read_costs(tmp_path / "nothing.toml")
    with pytest.raises(statehtn.InputError, match="this is no JSON"):
        statehtn.read_costs(written(tmp_path, "{", "costs.json"))
    with pytest.raises(statehtn.InputError, match="expected an object with keys"):
        statehtn.read_costs(written(tmp_path, "[1]", "costs.json"))
    (tmp_path / "bytes.toml").write_bytes(b"\xff")
    with pytest.raises(statehtn.InputError, match="byte 0 is not UTF-8"):
        statehtn.read_costs(tmp_path / "bytes.toml")


def test_scipy_that_is_missing_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "scipy.stats", None)
    file = written(tmp_path, '[[costs]]\naction = "brake"\ndistribution = "gamma"\nparameters = { a = 2 }')
    with pytest.raises(statehtn.UsageError, match=r"needs the package 'scipy': pip install 'statehtn\[scipy\]'"):
        statehtn.read_costs(file)


def test_the_command_line_takes_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = written(tmp_path, '[[costs]]\naction = "stop"\ndistribution = "gamma"\nparameters = { a = 2, scale = 0.5 }')
    output = str(tmp_path / "plan.txt")
    assert main(["plan", *AV, "--costs", str(file), "--json", "--output", output]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["plan"][-1]["outcomes"] is None
    assert found["plan"][-1]["law"] == "gamma(a=2, scale=0.5)"
    assert found["expected_cost"] == pytest.approx(18.35 - 0.4 + 1)
    assert main(["plan", *AV, "--costs", str(file)]) == 0
    assert "at least 10.6" in capsys.readouterr().out
    assert main(["validate", *AV, output, "--costs", str(file)]) == 0
    assert "gamma(a=2, scale=0.5)" in capsys.readouterr().out
    assert main(["plan", *AV, "--costs", str(file), "--attitude", "averse", "--alpha", "5"]) == 30
    message = f"the cost of (stop): gamma(a=2, scale=0.5) ({file}: entry 1 of 'costs'): E[e^(alpha C)] is infinite"
    assert message in capsys.readouterr().err
    assert main(["plan", *AV, "--costs", str(tmp_path / "none")]) == 30
    assert capsys.readouterr().err.startswith("error: cannot read")


def test_the_best_plans_at_the_costs_of_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "costs.toml"
    file.write_text('[[costs]]\naction = "start"\ncost = 100\n')
    assert main(["top", "2", *AV, "--costs", str(file), "--json"]) == 0
    plans = json.loads(capsys.readouterr().out)["plans"]
    assert all(plan["expected_cost"] > 100 for plan in plans)
