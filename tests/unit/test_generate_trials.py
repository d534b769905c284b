"""The generator of Trials problems: sizes, the files that come from it, and the formulas of their best chances."""

from __future__ import annotations

import shlex
import subprocess
import sys
from fractions import Fraction

import pytest

import statehtn
from statehtn.errors import UsageError
from statehtn.experiments.generate.trials import Way, trials_problem
from statehtn.model import Problem
from tests.explicit_graph import explicit_graph
from tests.explicit_policies import best_policy
from tests.regression.paper_tables import DOMAINS

TRIALS = DOMAINS / "trials"
FILES = sorted(path for path in TRIALS.glob("*.hddl") if path.stem != "domain")
HALF = Fraction(1, 2)
RISKY_OR_SAFE = (Way(Fraction("0.6")), Way(Fraction("0.85"), final=True))


def trials(steps: int, tries: int, *ways: Way) -> Problem:
    return statehtn.read_hddl_text((TRIALS / "domain.hddl").read_text(), trials_problem(steps, tries, ways))


def best_chance(problem: Problem) -> float:
    value = best_policy(explicit_graph(problem, 3000, largest_network=10), "success").value
    assert value is not None
    return float(value)


@pytest.mark.parametrize("size", [1, 2, 4])
def test_the_formulas(size: int) -> None:
    """Every try may be followed by another, unless it was the last one or a final one."""
    close = {"rel": 1e-12}
    assert best_chance(trials(size, 1, Way(Fraction("0.9")))) == pytest.approx(0.9**size, **close)
    ways = [Way(Fraction(i, i + 1)) for i in range(1, size + 1)]
    assert best_chance(trials(1, 1, *ways)) == pytest.approx(size / (size + 1), **close)
    assert best_chance(trials(1, size, Way(HALF))) == pytest.approx(1 - 0.5**size, **close)
    assert best_chance(trials(2, size, Way(HALF))) == pytest.approx((1 - 0.5**size) ** 2, **close)
    assert best_chance(trials(2, size, *RISKY_OR_SAFE)) == pytest.approx((1 - 0.15 * 0.4 ** (size - 1)) ** 2, **close)


def test_the_command_of_a_file_makes_it() -> None:
    assert FILES
    for file in FILES:
        command = file.read_text().splitlines()[0].partition("Made by: python ")[2]
        made = subprocess.run([sys.executable, *shlex.split(command)], capture_output=True, text=True, check=True)
        assert made.stdout == file.read_text()


@pytest.mark.parametrize(
    ("options", "found"),
    [
        ("--steps 0 --ways 0.5", "found 0 steps, 1 tries and 1 ways"),
        ("--steps 1 --ways 1.5", "expected chances from 0 to 1, found 3/2"),
        ("--steps 1 --ways half", "expected a chance such as 0.5, 2/3 or 0.85!, found 'half'"),
    ],
)
def test_what_is_no_problem(options: str, found: str) -> None:
    command = [sys.executable, "-m", "statehtn.experiments.generate", "trials", *options.split()]
    wrong = subprocess.run(command, capture_output=True, text=True)
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert found in wrong.stderr


def test_there_must_be_a_way() -> None:
    with pytest.raises(UsageError, match="0 ways"):
        trials_problem(1, 1, [])
