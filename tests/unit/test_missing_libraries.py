"""A library that is not installed is named in one line, with the extra that brings it; nothing else needs it."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.regression.paper_tables import problem
from tests.results import planned, write

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
AV = ("domains/av/domain.hddl", "domains/av/p1.hddl")
DASK = ("compare", "--suite", "paper", "--dask", "tcp://127.0.0.1:1")
NEEDED = {re.split(r"[^\w-]", dependency)[0] for dependency in PROJECT["dependencies"]}
OPTIONAL = ("matplotlib", "scipy", "pydot", "distributed", "jinja2", "unified_planning", "pandas", "IPython")


def python(missing: tuple[str, ...], code: str) -> subprocess.CompletedProcess[str]:
    """Run code in an interpreter that finds none of the packages in `missing`."""
    hide = f"import sys; sys.modules.update(dict.fromkeys({missing!r}))\n"
    command = [sys.executable, "-c", hide + code]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)


def statehtn(missing: tuple[str, ...], *arguments: str) -> subprocess.CompletedProcess[str]:
    code = f"from statehtn.cli import main\nsys.exit(main({list(arguments)!r}))"
    return python(missing, code)


def law(call: str) -> str:
    return f"law = statehtn.CostDistribution.of([(0.5, 1), (0.5, 2)])\n{call}"


PLANNED = f"result = statehtn.plan(statehtn.read_hddl({AV[0]!r}, {AV[1]!r}))\n"
LIBRARY = [
    ("matplotlib", "plots", law("law.plot()")),
    ("matplotlib", "plots", PLANNED + "result.plan.decomposition.plot()"),
    ("unified_planning", "up", "statehtn.register()"),
    ("unified_planning", "up", f"statehtn.relax(statehtn.read_hddl({AV[0]!r}, {AV[1]!r}))"),
    ("unified_planning", "up", "import statehtn.engine"),
]


@pytest.mark.parametrize(("library", "extra", "code"), LIBRARY)
def test_from_python(library: str, extra: str, code: str) -> None:
    caught = f"import statehtn\ntry:\n{_indented(code)}\nexcept statehtn.StateHtnError as error:\n    print(error)"
    run = python((library,), caught)
    assert run.stderr == ""
    assert_one_line(run.stdout, library, extra)


@pytest.mark.parametrize(
    ("library", "extra", "arguments"),
    [
        ("scipy", "scipy", ("plan", *AV, "--costs", "examples/av-costs.toml")),
        ("pydot", "graph", ("graph", *AV, "--kind", "cv-tdg", "--output", "{tmp}/graph.svg")),
        ("distributed", "dask", (*DASK, "--output", "{tmp}/results.csv")),
        ("jinja2", "report", ("report", "{results}", "--output", "{tmp}/report.html")),
        ("matplotlib", "report", ("report", "{results}", "--output", "{tmp}/report.html")),
    ],
)
def test_on_the_command_line(library: str, extra: str, arguments: tuple[str, ...], tmp_path: Path) -> None:
    results = tmp_path / "results.csv"
    if "{results}" in arguments:
        write(results, [planned(problem("av", "p1"), "av", "p1", "averse 0.9")])
    run = statehtn((library,), *(part.format(tmp=tmp_path, results=results) for part in arguments))
    assert (run.returncode, run.stdout) == (2, ""), run.stderr
    assert_one_line(run.stderr, library, extra)


def test_nothing_else_needs_them(tmp_path: Path) -> None:
    assert sorted(NEEDED) == ["networkx", "numpy", "rich"]
    plan = tmp_path / "plan.txt"
    averse = ("--attitude", "averse", "--alpha", "0.9")
    for arguments in (
        ("plan", *AV, *averse, "--output", str(plan)),
        ("plan", *AV, "--json", "--solver", "plan"),
        ("validate", *AV, str(plan)),
        ("top", "3", *AV),
        ("compare-attitudes", *AV, "--alpha", "0.9"),
        ("graph", *AV, "--kind", "cv-tdg", "--output", str(tmp_path / "graph.graphml")),
    ):
        run = statehtn(OPTIONAL, *arguments)
        assert run.returncode == 0, (arguments, run.stderr)
    run = python(OPTIONAL, f"import statehtn\n{PLANNED}print(result.plan.simulate(3, seed=1).shape)")
    assert run.stdout == "(3,)\n", run.stderr


def test_importing_asks_for_no_library_but_for_ones_that_are_needed_at_once() -> None:
    libraries = (*OPTIONAL, *NEEDED)
    run = python((), f"import statehtn\nprint([name for name in sys.modules if name in {libraries!r}])")
    assert run.stdout == "[]\n"


def assert_one_line(text: str, library: str, extra: str) -> None:
    assert text.count("\n") == 1, text
    assert library.replace("_", "-") in text
    assert f"pip install 'statehtn[{extra}]'" in text
    assert extra in PROJECT["optional-dependencies"]


def _indented(code: str) -> str:
    return "".join(f"    {line}\n" for line in code.splitlines())
