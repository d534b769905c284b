"""Limits while plans and samples are read: a large file is not read whole before anybody looks at them."""

from __future__ import annotations

import importlib
import json
import sys
import tracemalloc
from pathlib import Path

import pytest

import statehtn
from statehtn import read_file
from statehtn.build.cost_file import read_costs
from statehtn.cli import main
from statehtn.cli.plan_files import read_plan_file
from statehtn.hddl.action_list import read_actions
from statehtn.hddl.plan_lines import PIECE, lines_of
from statehtn.keyed_file import NUMBERS, read_tables
from statehtn.limits import LimitReached, Limits, watched
from statehtn.model.status import Status
from tests.counted_limits import CountedLimits
from tests.unit.test_unread_plans import PROBLEM, WALK


@pytest.fixture
def small_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(read_file, "PIECE", 5)


def costs_of(tmp_path: Path, samples: str, limits: Limits = Limits()) -> tuple[tuple[float, float], ...]:
    (tmp_path / "samples.txt").write_text(samples, encoding="utf-8")
    (tmp_path / "costs.toml").write_text('[[costs]]\naction = "ride"\nsamples = "samples.txt"\n')
    law = read_costs(tmp_path / "costs.toml", limits).entries[0].law
    assert isinstance(law, statehtn.CostDistribution)
    return law.outcomes


@pytest.mark.usefixtures("small_pieces")
@pytest.mark.parametrize(
    "text", ["1 22 333;4444,1", "1\n22\n333\n4444\n1\n", "  1,,22   333 4444 1  ", "1 22 333.0 4.444e3 1"]
)
def test_numbers_go_on_in_the_next_piece(text: str, tmp_path: Path) -> None:
    assert costs_of(tmp_path, text) == ((0.4, 1.0), (0.2, 22.0), (0.2, 333.0), (0.2, 4444.0))


@pytest.mark.usefixtures("small_pieces")
@pytest.mark.parametrize(
    ("samples", "words"),
    [
        (b"1 2 3 4 5 6 b\xc3\xa4ume 7", "expected numbers in .*, found 'b\u00e4ume'"),
        (b"1 2 3 4 5 6 \xff", "is no text file"),
        (b"1 2 3 4 5 6 \xc3", "is no text file"),
        (b" \n ", "at least one observation"),
    ],
)
def test_mistakes_in_later_pieces(samples: bytes, words: str, tmp_path: Path) -> None:
    (tmp_path / "samples.txt").write_bytes(samples)
    (tmp_path / "costs.toml").write_text('[[costs]]\naction = "ride"\nsamples = "samples.txt"\n')
    with pytest.raises(statehtn.InputError, match=words) as raised:
        read_costs(tmp_path / "costs.toml")
    assert raised.value.message.count("entry 1 of 'costs'") == 1


@pytest.mark.usefixtures("small_pieces")
def test_samples_are_read_piece_by_piece(tmp_path: Path) -> None:
    limits = CountedLimits()
    costs_of(tmp_path, "1 2 3 " * 100, limits)
    assert len(limits.looks) >= 600 / 5
    with pytest.raises(LimitReached):
        costs_of(tmp_path, "1 2 3 " * 100, CountedLimits(last=60))


def test_numbers_in_json_and_toml_look_at_the_limits(tmp_path: Path) -> None:
    many = ", ".join(f"{number}.5" for number in range(3 * NUMBERS))
    (tmp_path / "costs.json").write_text(f'{{"samples": [{many}], "count": 12345678901234567890}}')
    (tmp_path / "costs.toml").write_text(f"samples = [{many}]\ncount = 3\n")
    for name in ("costs.json", "costs.toml"):
        limits = CountedLimits()
        tables = read_tables(tmp_path / name, limits)
        assert tables["samples"][-1] == 3 * NUMBERS - 0.5
        assert isinstance(tables["count"], int)
        assert len(limits.looks) >= 5  # two for the file
        with pytest.raises(LimitReached):
            read_tables(tmp_path / name, CountedLimits(last=5))


@pytest.mark.parametrize("text", ["", "a", "a\n", "\n", "a\r\nb\rc\x0bd\n\n", "x" * PIECE + "\ny\n" + "z" * PIECE])
def test_lines_are_those_of_the_whole_text(text: str) -> None:
    assert list(lines_of(text)) == text.splitlines()


def test_a_list_of_actions_is_not_copied_while_it_is_read() -> None:
    problem = statehtn.read_hddl_text(WALK, PROBLEM)
    text = "(ride)\n" * 20_000
    tracemalloc.start()
    steps = read_actions(text, problem)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert steps is not None
    assert len(steps) == 20_000
    assert peak < 60 * len(steps)  # a line as a text of its own has 56 bytes, beside a place in a list


def over(limit: Status) -> Limits:
    """Return limits that are over already, of time or of memory."""
    return Limits(deadline=0.0) if limit is Status.TIME_LIMIT else Limits(memory_mb=1e-6)


@pytest.mark.parametrize(("limit", "code"), [(Status.TIME_LIMIT, 20), (Status.MEMORY_LIMIT, 21)])
@pytest.mark.parametrize("plan", ["(ride)\n", "==>\n0 ride\nroot 1\n1 go -> by-bus 0\n<==\n"])
def test_limits_hold_while_a_plan_is_read(
    limit: Status,
    code: int,
    plan: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    for name, text in (("d.hddl", WALK), ("p.hddl", PROBLEM), ("plan.txt", plan)):
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(
        "statehtn.cli.validate_command.read_plan_file",
        lambda name, problem, _: read_plan_file(name, problem, over(limit)),
    )
    arguments = [str(tmp_path / name) for name in ("d.hddl", "p.hddl", "plan.txt")]
    assert main(["validate", *arguments, "--json"]) == code
    found = json.loads(capsys.readouterr().out)
    assert (found["valid"], found["stopped"]) == (None, limit.value)
    assert main(["validate", *arguments]) == code
    assert "not checked" in capsys.readouterr().out


def test_limits_hold_while_a_list_of_actions_is_made_steps() -> None:
    problem = statehtn.read_hddl_text(WALK, PROBLEM)
    with pytest.raises(LimitReached):
        statehtn.validate(problem, ["(ride)"] * 1_000_000, time_limit=0.2)


SLOW = """
import time
end = time.monotonic() + {seconds}
while time.monotonic() < end:
    time.sleep(0.01)
"""
SLY = """
import time
try:
    time.sleep(60)
except BaseException:
    raise ImportError("it failed")
"""


def test_an_import_is_ended_where_the_process_ends_with_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "slow_to_end.py").write_text(SLOW.format(seconds=60))
    with pytest.raises(LimitReached), watched(Limits(deadline=0.0), ends_imports=True):
        importlib.import_module("slow_to_end")
    assert "slow_to_end" not in sys.modules
    (tmp_path / "slow_and_sly.py").write_text(SLY)
    with pytest.raises(LimitReached), watched(Limits(deadline=0.0), ends_imports=True):
        importlib.import_module("slow_and_sly")
    (tmp_path / "slow_to_stay.py").write_text(SLOW.format(seconds=0.3))
    with pytest.raises(LimitReached), watched(Limits(deadline=0.0)):
        importlib.import_module("slow_to_stay")
    assert sys.modules.pop("slow_to_stay").end > 0
