"""What a type checker sees: misspelt names are errors."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import get_args

import pytest

from statehtn.compatible import HEURISTIC_CHOICES, SOLVERS
from statehtn.core.heuristics import ADMISSIBLE
from statehtn.core.plan_based import BRANCHES
from statehtn.core.searches import SEARCHES
from statehtn.core.top_plans import DISTINCT
from statehtn.risk import Attitude, AttitudeName
from statehtn.settings import BranchName, DistinctName, HeuristicName, SearchName, SolverName, TopHeuristicName

ROOT = Path(__file__).parents[2]
SCRIPT = """
import statehtn
import statehtn.interop

statehtn.plann(3)  # WRONG
statehtn.reed_hddl("d.hddl", "p.hddl")  # WRONG
statehtn.interop.Conversationn  # WRONG
problem = statehtn.read_hddl("d.hddl", "p.hddl")
statehtn.plan(problem, attitude="avers", alpha=0.1)  # WRONG
statehtn.plan(problem, search="astra")  # WRONG
statehtn.plan(problem, heuristic="lmcutt")  # WRONG
statehtn.plan(problem, solver="stat")  # WRONG
statehtn.plan(problem, branch="some")  # WRONG
statehtn.top_plans(problem, 3, distinct="sequense")  # WRONG
statehtn.top_plans(problem, 3, heuristic="ff")  # WRONG
statehtn.compare_attitudes(problem, attitudes=["avers"])  # WRONG
statehtn.utility_for("sneaking", 1)  # WRONG
statehtn.plan(problem, attitude="averse", alpha=0.1, search="anytime", heuristic="auto")
for attitude in statehtn.Attitude:
    for result in statehtn.improving(problem, attitude=attitude, alpha=1):
        print(statehtn.__version__.upper(), result.status, result.plan)
"""


def test_misspelt_names_are_type_errors(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    (tmp_path / "script.py").write_text(SCRIPT)
    command = [sys.executable, "-m", "mypy", "--config-file", str(ROOT / "pyproject.toml"), str(tmp_path / "script.py")]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, timeout=120)
    found = {int(line.split(":")[1]) for line in run.stdout.splitlines() if "script.py:" in line and " error: " in line}
    wrong = {number for number, line in enumerate(SCRIPT.splitlines(), 1) if line.endswith("# WRONG")}
    assert found == wrong, run.stdout + run.stderr


@pytest.mark.parametrize(
    ("names", "known"),
    [
        (AttitudeName, [attitude.value for attitude in Attitude]),
        (SolverName, SOLVERS),
        (SearchName, SEARCHES),
        (HeuristicName, HEURISTIC_CHOICES),
        (BranchName, BRANCHES),
        (TopHeuristicName, ADMISSIBLE),
        (DistinctName, DISTINCT),
    ],
)
def test_the_names_for_type_checkers_are_those_that_there_are(names: object, known: object) -> None:
    assert set(get_args(names)) == set(known)
