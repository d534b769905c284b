"""Files are read in pieces under limits: pipes that do not begin, devices that do not end."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import InputError, read_costs, read_hddl
from statehtn.cli import main
from statehtn.limits import LimitReached, Limits
from statehtn.model import TypeHierarchy
from statehtn.read_file import PIECE, read_pieces

DOMAIN = "(define (domain d) (:predicates (there)) (:action go :parameters () :effect (there)))"
PROBLEM = "(define (problem p) (:domain d) (:htn :subtasks (go)) (:init))"


@pytest.fixture
def pipe(tmp_path: Path) -> Path:
    os.mkfifo(tmp_path / "pipe")
    return tmp_path / "pipe"


def test_a_pipe_that_nobody_writes_ends_at_the_limit(pipe: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(LimitReached):
        list(read_pieces(pipe, Limits.starting_now(0.1)))
    with pytest.raises(LimitReached):
        read_hddl(pipe, pipe, limits=Limits.starting_now(0.1))
    with pytest.raises(LimitReached):
        read_costs(pipe, Limits.starting_now(0.1))
    assert main(["plan", str(pipe), str(pipe), "--time-limit", "0.1"]) == 20
    assert "time limit reached" in capsys.readouterr().out


def test_a_pipe_is_read_to_its_end(pipe: Path, tmp_path: Path) -> None:
    text = DOMAIN + "\n;" + "x" * (3 * PIECE)
    (tmp_path / "p.hddl").write_text(PROBLEM)
    writer = threading.Thread(target=pipe.write_text, args=(text,))
    writer.start()
    assert read_hddl(pipe, tmp_path / "p.hddl", limits=Limits.starting_now(60)).domain.name == "d"
    writer.join()


def test_a_device_without_an_end_is_no_text() -> None:
    with pytest.raises(InputError, match="binary"):
        read_hddl("/dev/zero", "/dev/zero")
    with pytest.raises(LimitReached):
        read_costs("/dev/zero", Limits.starting_now(0.1))
    with pytest.raises(LimitReached):
        read_costs("/dev/zero", Limits.starting_now(memory_limit=1))


def test_a_name_that_no_file_can_have() -> None:
    with pytest.raises(InputError, match="cannot read"):
        read_costs("a\0b")


@given(st.lists(st.lists(st.integers(0, 9), max_size=2), min_size=10, max_size=10), st.sets(st.integers(0, 9)))
def test_types_below_are_those_that_have_them_above(above: list[list[int]], asked: set[int]) -> None:
    parents = {f"t{name}": tuple(f"t{one}" for one in found) for name, found in enumerate(above)}
    hierarchy = TypeHierarchy(parents)
    names = {f"t{one}" for one in asked}
    assert hierarchy.subtypes(names) == {name for name in parents if hierarchy.is_subtype(name, names)}
    assert hierarchy.subtypes(["object"]) == {"object", *parents}
