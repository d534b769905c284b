"""Exit codes of what cannot be written: the same for every command that writes a file, and as help and page say."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

import pytest

from statehtn.cli import main
from statehtn.cli.arguments import make_parser
from statehtn.cli.epilogs import WRITING
from tests.pages import ROOT
from tests.test_minimal import DOMAIN, PROBLEM

Capture = pytest.CaptureFixture[str]
GRIPPER = ["domains/gripper-robot/domain.hddl", "domains/gripper-robot/p1.hddl"]
AV = ["domains/av/domain.hddl", "domains/av/p1.hddl"]
WRITERS = {
    "plan": ["plan", *AV, "--quiet", "--output"],
    "top": ["top", "1", *AV, "--output"],
    "policy": ["policy", *GRIPPER, "--quiet", "--dot"],
    "export": ["export", *GRIPPER, "--prism"],
    "graph": ["graph", *AV, "--format", "dot", "--output"],
    "atlas": ["atlas", *AV, "--alpha-from", "0", "--alpha-to", "0.1", "--output"],
    "compare": ["compare", "--quiet", "--suite"],
    "report": ["report", "no.csv", "--output"],
}
WITHOUT_FILES = {"validate", "check", "why", "compare-attitudes", "attitude", "completion"}


def commands() -> dict[str, argparse.ArgumentParser]:
    (action,) = (a for a in make_parser()._actions if isinstance(a, argparse._SubParsersAction))
    return dict(action.choices)


@pytest.fixture
def suite(tmp_path: Path) -> list[str]:
    """The words after `compare --suite`."""
    (tmp_path / "domain.hddl").write_text(DOMAIN)
    (tmp_path / "p1.hddl").write_text(PROBLEM)
    runs = '[[runs]]\ndomain = "domain.hddl"\nproblems = "p1.hddl"\nname = "errands"\n'
    (tmp_path / "my.toml").write_text(runs)
    return [str(tmp_path / "my.toml"), "--output"]


@pytest.mark.parametrize("command", WRITERS)
def test_a_missing_directory_is_a_mistake_of_usage(
    command: str, suite: list[str], tmp_path: Path, capsys: Capture
) -> None:
    words = [*WRITERS[command], *(suite if command == "compare" else [])]
    assert main([*words, str(tmp_path / "nowhere" / "file")]) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert "cannot write" in shown.err
    assert shown.err.count("\n") == 1


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no full device")  # noqa: PTH110
@pytest.mark.parametrize("command", [name for name in WRITERS if name not in ("top", "compare", "report")])
def test_a_full_disk_is_none(command: str, capsys: Capture) -> None:
    pytest.importorskip("pydot")
    assert main([*WRITERS[command], "/dev/full"]) == 74
    assert "No space left on device" in capsys.readouterr().err


@pytest.mark.parametrize("command", sorted({*WRITERS, *WITHOUT_FILES}))
def test_help_and_page_say_so(command: str, capsys: Capture) -> None:
    assert {*WRITERS, *WITHOUT_FILES} == {*commands()}
    assert main([command, "--help"]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert (" ".join(WRITING.split()) in shown) == (command in WRITERS)
    if command not in ("compare-attitudes", "atlas", "completion"):  # those say: as of 'statehtn plan', or nothing
        assert "74 cannot write" in shown
    page = " ".join((ROOT / "docs" / "exit-codes.md").read_text(encoding="utf-8").split())
    assert f"`statehtn {command}` ends" in page or f"`statehtn {command}` |" in page
