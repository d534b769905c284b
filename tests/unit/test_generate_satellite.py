"""The generator of Satellite problems: sizes, seeds, and the files that come from it."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from collections import Counter
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn
from statehtn.errors import UsageError
from statehtn.experiments.generate.satellite import satellite_problem
from tests.regression.paper_tables import DOMAINS, solve

LARGE = sorted((DOMAINS / "satellite/large").glob("*.hddl"))
DOMAIN = (DOMAINS / "satellite/domain.hddl").read_text()


@st.composite
def sizes(draw: st.DrawFn) -> tuple[int, int, int]:
    """Draw observations, satellites and modes."""
    modes = draw(st.integers(2, 13))
    return draw(st.integers(modes, 20)), draw(st.integers(1, modes)), modes


@given(sizes(), st.integers(0, 2**40), st.booleans())
def test_a_problem_has_its_sizes(size: tuple[int, int, int], seed: int, ordered: bool) -> None:
    observations, satellites, modes = size
    text = satellite_problem(*size, seed, ordered=ordered)
    assert text == satellite_problem(*size, seed, ordered=ordered)
    problem = statehtn.read_hddl_text(DOMAIN, text)
    kinds = Counter(problem.objects.values())
    assert kinds["satellite"] == kinds["direction"] == satellites
    assert kinds["instrument"] == kinds["mode"] == modes
    assert kinds["phenomenon"] == observations
    wanted = re.findall(r"\(observe (\S+) ([^\s)]+)\)", text)
    assert len({phenomenon for phenomenon, _ in wanted}) == len(wanted) == observations
    in_order = [mode for _, mode in wanted]
    assert len(set(in_order)) == modes
    assert all(before != after for before, after in pairwise(in_order))
    on_board = re.findall(r"\(on-board (\S+) ([^\s)]+)\) \(supports (\S+) ([^\s)]+)\)", text)
    assert len({instrument for instrument, *_ in on_board}) == len({mode for *_, mode in on_board}) == modes
    assert len({satellite for _, satellite, *_ in on_board}) == satellites
    assert all(instrument == same for instrument, _, same, _ in on_board)


def test_seeds_differ() -> None:
    assert len({satellite_problem(10, 2, 4, seed) for seed in range(20)}) == 20


@pytest.mark.parametrize("size", [(3, 1, 4), (3, 4, 3), (3, 0, 3), (3, 1, 1), (0, 0, 0), (-1, 1, 2)])
def test_impossible_sizes(size: tuple[int, int, int]) -> None:
    with pytest.raises(UsageError, match=f"{size[1]} satellites"):
        satellite_problem(*size, 1)


def test_the_files_are_what_the_generator_makes() -> None:
    for file in LARGE:
        text = file.read_text()
        command = text.splitlines()[0].partition("satellite ")[2]
        words = shlex.split(command)
        numbers = [
            int(words[words.index(f"--{option}") + 1]) for option in ("observations", "satellites", "modes", "seed")
        ]
        ordered = "--unordered" not in words
        assert text == satellite_problem(*numbers, ordered=ordered)
        assert file.stem == "RA-{}obs-{}sat-{}mod".format(*numbers) + ("" if ordered else "-unordered")
        assert numbers[1] == 1
        assert 5 <= numbers[0] <= 10
        assert numbers[2] >= 3


def test_the_command_of_a_file_makes_it() -> None:
    command = LARGE[0].read_text().splitlines()[0].partition("Made by: python ")[2]
    made = subprocess.run([sys.executable, *shlex.split(command)], capture_output=True, text=True, check=True)
    assert made.stdout == LARGE[0].read_text()
    wrong = subprocess.run([sys.executable, *shlex.split(command), "--modes", "99"], capture_output=True, text=True)
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert wrong.stderr.startswith("error: expected at least 1 satellite")


README = (DOMAINS / "satellite/README.md").read_text().partition("## Large instances")[2]
RESULTS = re.findall(r"^\| (RA-\S+) \| (.*) \| (.*) \| (.*) \|$", README, re.MULTILINE)


def test_every_ordered_file_has_its_results() -> None:
    assert {name for name, *_ in RESULTS} == {file.stem for file in LARGE if not file.stem.endswith("-unordered")}


@pytest.mark.parametrize("row", RESULTS, ids=lambda row: row[0])
def test_results(row: tuple[str, ...]) -> None:
    name, *printed = row
    for attitude, result in zip(("averse", "neutral", "seeking"), printed, strict=True):
        best = solve("satellite", f"large/{name}", attitude, None if attitude == "neutral" else 0.5)
        assert f"{best.length} / {best.expected_cost:.2f}" == result
