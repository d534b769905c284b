"""Suites: which runs they ask for, what a file of one's own may say, and which combinations are left out."""

from __future__ import annotations

import csv
import warnings
from collections import Counter
from itertools import groupby
from pathlib import Path

import pytest

from statehtn.cli import main
from statehtn.compatible import PRICE_SWITCHES, SOLVERS
from statehtn.errors import InputError, StateHtnError, UsageError
from statehtn.experiments import suites
from statehtn.experiments.run import Grid, Run
from statehtn.experiments.suites import runs_of
from statehtn.risk import utility_for
from tests.regression.paper_tables import DOMAINS, alpha_of, rows
from tests.test_minimal import DOMAIN, PROBLEM


def settings(runs: list[Run]) -> set[tuple[object, ...]]:
    names = ("attitude", "alpha", "solver", "heuristic", "search")
    return {tuple(run.to_dict()[name] for name in names) for run in runs}


def test_what_does_not_exist_is_left_out(tree: Path) -> None:
    asked = Grid(solvers=("plan",), heuristics=("lmcut", "tdg"), searches=("astar", "greedy"))
    with pytest.warns(UserWarning, match="left out: ") as warned:
        runs = runs_of("ipc", asked, tree)
    assert [str(warning.message) for warning in warned] == [
        "left out: plan lmcut (the solver 'plan' has no state, which 'lmcut' needs; its heuristics are tdg and blind)",
        "left out: plan/greedy lmcut, plan/greedy tdg (the solver 'plan' has no search but 'astar', found 'greedy')",
    ]
    assert settings(runs) == {("neutral", None, "plan", "tdg", "astar")}
    with pytest.raises(UsageError, match="none of these settings exists: plan lmcut"):
        runs_of("ipc", Grid(solvers=("plan",), heuristics=("lmcut",)), tree)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(runs_of("ipc", Grid(heuristics=("tdg",)), tree)) == 3


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for name in ("trips", "errands"):
        folder = tmp_path / "tree" / name
        folder.mkdir(parents=True)
        (folder / "domain.hddl").write_text(DOMAIN)
        (folder / "p1.hddl").write_text(PROBLEM)
    (folder / "p2.hddl").write_text(PROBLEM)
    return tmp_path / "tree"


def test_paper() -> None:
    runs = runs_of("paper", Grid(solvers=("state",)), DOMAINS)
    assert Counter(run.instance.domain for run in runs) == {"av": 25, "satellite": 48 + 64}
    ours = {(run.instance.problem.upper(), run.settings.objective) for run in runs}
    for table in ("av_results", "satellite_results"):
        for row in rows(table):
            assert (row["instance"].upper(), utility_for(row["attitude"], alpha_of(row))) in ours
    alphas = {run.to_dict()["alpha"] for run in runs if run.instance.domain == "satellite"}
    assert alphas == {None, 0.1, 0.5, 0.9}
    assert all(Path(file).is_file() for run in runs for file in (run.instance.domain_file, run.instance.problem_file))
    assert {run.settings.solver for run in runs_of("paper", Grid(), DOMAINS)} == set(SOLVERS)


def test_satellite_large() -> None:
    runs = runs_of("satellite-large", Grid(solvers=("state",), repeat=2), DOMAINS)
    assert len(runs) == 29 * 3 * 2
    assert settings(runs) == {
        (attitude, None if attitude == "neutral" else 0.5, "state", "auto", "astar")
        for attitude in ("neutral", "averse", "seeking")
    }
    assert [repeat for repeat, _ in groupby(run.repeat for run in runs)] == [1, 2]  # all once, then all again
    assert (runs[0].time_limit, runs[0].memory_limit) == (60, 4000)


def test_what_is_asked_for_counts_instead_of_the_suites_own() -> None:
    asked = Grid(
        objectives=(utility_for("averse", 2.0),), heuristics=("tdg",), searches=("astar", "greedy"), time_limit=5
    )
    with pytest.warns(UserWarning, match="left out: plan/greedy tdg"):
        runs = runs_of("satellite-large", asked, DOMAINS)
    assert settings([run for run in runs if run.settings.solver == "state"]) == {
        ("averse", 2.0, "state", "tdg", "astar"),
        ("averse", 2.0, "state", "tdg", "greedy"),
    }
    assert {run.time_limit for run in runs} == {5}


def test_own_problems_are_found_from_anywhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert len(runs_of("satellite-large", Grid(solvers=("state",)))) == 87  # beside the sources
    monkeypatch.setattr(suites, "__file__", str(tmp_path / "site/statehtn/experiments/suites.py"))
    with pytest.raises(InputError, match=r"not here or beside the package.*--root"):
        runs_of("satellite-large", Grid())
    with pytest.raises(InputError, match=r"not in '.*--root"):
        runs_of("paper", Grid(), tmp_path)
    (tmp_path / "domains").symlink_to(DOMAINS)
    assert len(runs_of("satellite-large", Grid(solvers=("state",)))) == 87
    (tmp_path / "domains").unlink()
    (tmp_path / "domains/av").mkdir(parents=True)
    (tmp_path / "domains/av/domain.hddl").write_text(DOMAIN)
    for suite in ("paper", "satellite-large"):
        with pytest.raises(InputError, match="is missing|no problem"):
            runs_of(suite, Grid())


FILE = """
attitudes = ["neutral", "averse"]
alphas = [0.5]
repeat = 2
time-limit = 5

[[runs]]
domain = "trips/domain.hddl"
problems = "trips/*.hddl"
heuristics = ["tdg", "hmax"]

[[runs]]
name = "other"
domain = "errands/domain.hddl"
problems = ["errands/p2.hddl", "errands/p?.hddl"]
attitudes = ["neutral", "neutral"]
repeat = 1
memory-limit = 100
"""


def test_refinements_are_left_out(tree: Path) -> None:
    text = FILE.replace('heuristics = ["tdg", "hmax"]', 'without = ["nothing", "forget_facts", "inherit_h+endings"]')
    runs = [run for run in runs_of(suite(tree, text), Grid()) if run.instance.domain == "trips" and run.repeat == 1]
    labels = ["state", "state without forget_facts", "state without endings+inherit_h"]
    assert [run.key[4] for run in runs] == labels * 2
    assert [name for name in PRICE_SWITCHES if not getattr(runs[2].settings.switches, name)] == ["inherit_h", "endings"]
    assert [run.key[4] for run in runs_of("ipc", Grid(without=(("endings",),)), tree)] == ["state without endings"] * 3
    with pytest.raises(InputError, match=r"'without'.*stubborn_sets.*'sets'"):
        runs_of(suite(tree, FILE.replace("repeat = 2", 'without = "sets"')), Grid())
    with pytest.raises(InputError, match=r"'nothing' alone.*'nothing\+endings'"):
        runs_of(suite(tree, FILE.replace("repeat = 2", 'without = "nothing+endings"')), Grid())
    with pytest.warns(UserWarning, match="left out: plan without endings .* none of the refinements of 'state'"):
        assert len(runs_of("ipc", Grid(solvers=("plan",), without=((), ("endings",))), tree)) == 3


def suite(tree: Path, text: str) -> str:
    (tree / "my.toml").write_text(text)
    return str(tree / "my.toml")


def test_a_file(tree: Path) -> None:
    runs = runs_of(suite(tree, FILE), Grid())
    first = [run for run in runs if run.instance.domain == "trips"]
    assert settings(first) == {
        (attitude, alpha, "state", heuristic, "astar")
        for attitude, alpha in (("neutral", None), ("averse", 0.5))
        for heuristic in ("tdg", "hmax")
    }
    assert Counter(run.repeat for run in first) == {1: 4, 2: 4}
    assert {(run.instance.problem, run.time_limit, run.memory_limit) for run in first} == {("p1", 5, 4000)}
    second = [run for run in runs if run.instance.domain == "other"]
    assert [run.instance.problem for run in second] == ["p2", "p1"]
    assert settings(second) == {("neutral", None, "state", "auto", "astar")}
    assert {(run.repeat, run.time_limit, run.memory_limit) for run in second} == {(1, 5, 100)}
    assert [run.repeat for run in runs] == sorted(run.repeat for run in runs)
    assert settings(
        runs_of(suite(tree, FILE), Grid(heuristics=("blind",), repeat=1, objectives=(utility_for("neutral"),)))
    ) == {("neutral", None, "state", "blind", "astar")}


def test_a_file_on_the_command_line(tree: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = tree / "results.csv"
    for _ in range(2):
        options = ["--suite", suite(tree, FILE), "--problem", "p2", "--output", str(output)]
        assert main(["compare", *options, "--heuristic", "blind", "--jobs", "2"]) == 0
    (row,) = csv.DictReader(output.read_text().splitlines())
    assert [row[name] for name in ("domain", "problem", "heuristic", "status")] == ["other", "p2", "blind", "optimal"]
    assert capsys.readouterr().err == ""


RUNS = '[[runs]]\ndomain = "trips/domain.hddl"\nproblems = "trips/p1.hddl"\n'


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("repeat = \n", "line 1"),
        ("", "[[runs]]"),
        ("runs = 1", "[[runs]]"),
        ("runs = []", "[[runs]]"),
        ("[runs]\ndomain = 'x'", "[[runs]]"),
        (f"domain = 'trips/domain.hddl'\n{RUNS}", "unknown key 'domain'"),
        (f"{RUNS}attitude = 'neutral'", "[[runs]] 1: unknown key 'attitude'"),
        (f"{RUNS}{RUNS}searches = ['dfs']", "[[runs]] 2: 'searches': expected some of astar"),
        (f"{RUNS}heuristics = 'magic'", "'magic'"),
        (f"{RUNS}solvers = []", "'solvers': expected text"),
        (f"{RUNS}solvers = [1]", "found [1]"),
        (f"{RUNS}attitudes = ['averse']", "needs an alpha ('attitudes', 'alphas', 'objectives')"),
        (f"{RUNS}alphas = [1]", "neutral agent has no alpha"),
        (f"alphas = [1]\nattitudes = 'seeking'\n{RUNS}attitudes = 'averse'", "needs an alpha"),
        (f"{RUNS}attitudes = 'averse'\nalphas = [0.1, -1]", "'alphas': expected positive numbers, found -1"),
        (f"{RUNS}attitudes = 'averse'\nalphas = nan", "'alphas'"),
        (f"{RUNS}attitudes = 'averse'\nalphas = true", "found true"),
        (f"{RUNS}repeat = 0", "'repeat': expected a whole number of at least 1, found 0"),
        (f"{RUNS}repeat = 1.5", "'repeat'"),
        (f"{RUNS}time-limit = '1'", "'time-limit': expected a positive number"),
        (f"{RUNS}memory-limit = 0", "'memory-limit'"),
        ("[[runs]]\nproblems = '*'", "[[runs]] 1: 'domain' is missing"),
        ("[[runs]]\ndomain = 'trips/domain.hddl'", "'problems' is missing"),
        ("[[runs]]\ndomain = 'trips'\nproblems = '*'", "'domain': expected the path of a file"),
        ("[[runs]]\ndomain = 'trips/domain.hddl'\nproblems = 'trips/q*.hddl'", "found 'trips/q*.hddl'"),
        ("[[runs]]\ndomain = 'trips/domain.hddl'\nproblems = '/nowhere/*.hddl'", "/nowhere"),
        ("[[runs]]\ndomain = 'trips/domain.hddl'\nproblems = 'trips/domain.hdd?'", "'problems'"),
        (f"{RUNS}{RUNS.replace('trips/d', 'errands/d')}name = 'trips'", "give its domains different names"),
        (f"{RUNS}{RUNS}time-limit = 3", "limits"),
    ],
)
def test_mistakes_in_a_file(tree: Path, text: str, words: str) -> None:
    with pytest.raises(InputError) as error:
        runs_of(suite(tree, text), Grid())
    assert words in str(error.value)
    assert str(tree / "my.toml") in str(error.value)
    assert "\n" not in str(error.value)


def test_no_file(tree: Path) -> None:
    (tree / "latin.toml").write_bytes(b"# \xe9\n")
    (tree / "folder.toml").mkdir()
    for name, words in (("none.toml", "No such file"), ("latin.toml", "UTF-8"), ("folder.toml", "directory")):
        with pytest.raises(InputError, match=words):
            runs_of(str(tree / name), Grid())
    for arguments in (("magic", Grid()), (suite(tree, RUNS), Grid(), tree)):
        with pytest.raises(UsageError):
            runs_of(*arguments)


def test_the_example_of_the_documentation(tmp_path: Path) -> None:
    page = (DOMAINS.parent / "docs/compare.md").read_text()
    text = page.partition("```toml\n")[2].partition("```")[0]
    (tmp_path / "domains").symlink_to(DOMAINS)
    try:
        runs = runs_of(suite(tmp_path, text), Grid())
    except StateHtnError as error:
        pytest.fail(str(error))
    assert len(runs) == int(page.partition("That is ")[2].partition(" runs")[0])
