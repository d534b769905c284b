"""The verifier of the planning competitions accepts a plan from each of their domains; `nox -s verifier` builds it.

It shares no code with the project, and compares names strictly, with their case.
"""

from __future__ import annotations

import os
import subprocess
import sys
from itertools import groupby
from pathlib import Path

import pytest

from statehtn.experiments.instances import find_instances
from statehtn.experiments.run import Instance

VERIFIER = os.environ.get("STATEHTN_VERIFIER_PROGRAM", "")
FOLDERS = [Path(os.environ[name]) for name in ("STATEHTN_IPC", "STATEHTN_IPC2023") if os.environ.get(name)]
SECONDS = 10
TRIED = 3  # problems of a domain, the smallest first
SEARCHES = ("astar", "greedy")
DOMAINS = [
    pytest.param(list(instances), id=f"{folder.name}/{domain}")
    for folder in (FOLDERS if VERIFIER else [])
    for domain, instances in groupby(find_instances(folder), lambda instance: instance.domain)
]

pytestmark = pytest.mark.skipif(
    not DOMAINS, reason="there is no verifier, or there are no problems: see nox -s verifier"
)


def size(instance: Instance) -> int:
    return Path(instance.problem_file).stat().st_size


def is_solved(instance: Instance, search: str, plan: Path) -> bool:
    """Write a plan of the problem if one is found in time; proven to be unsolvable, or out of time, is no failure."""
    command = [
        sys.executable,
        "-m",
        "statehtn",
        "plan",
        instance.domain_file,
        instance.problem_file,
        "--search",
        search,
    ]
    limits = ["--time-limit", str(SECONDS), "--memory-limit", "4000", "--quiet", "--output", str(plan)]
    run = subprocess.run([*command, *limits], capture_output=True, text=True, timeout=30 * SECONDS)
    assert run.returncode in (0, 10, 12, 20, 21), run.stderr
    return run.returncode == 0


@pytest.mark.parametrize("instances", DOMAINS)
def test_the_verifier_accepts_a_plan(instances: list[Instance], tmp_path: Path) -> None:
    plan = tmp_path / "plan"
    smallest = sorted(instances, key=size)[:TRIED]
    solved = next((one for search in SEARCHES for one in smallest if is_solved(one, search, plan)), None)
    if solved is None:
        pytest.skip(f"no plan for any of {', '.join(one.problem for one in smallest)} within {SECONDS} s")
    command = [VERIFIER, "-C", "-V", solved.domain_file, solved.problem_file, str(plan)]
    run = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=60 * SECONDS)
    assert "Plan verification result: true" in run.stdout, (
        f"{solved.problem}:\n{run.stdout[-2000:]}{run.stderr[-2000:]}"
    )
