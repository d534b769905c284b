"""Misspelt words on the command line get a suggestion; help has columns that are as wide as they need to be."""

from __future__ import annotations

import pytest

from statehtn.cli import main
from statehtn.cli.epilogs import described

Capture = pytest.CaptureFixture[str]


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("plan d p --atitude averse", "unknown option --atitude (did you mean '--attitude'?)"),
        ("plan d p --atitude=averse", "unknown option --atitude (did you mean '--attitude'?)"),
        (
            "report --outpt page.html results.csv",
            "unknown option --outpt (did you mean '--output'?)",
        ),
        ("--verson", "did you mean '--version'?"),
        ("plann d p", "there is no 'plann' (did you mean 'plan'?)"),
        (
            "plan d p --attitude avers --alpha 1",
            "there is no 'avers' (did you mean 'averse'?); choose from neutral",
        ),
        ("plan d p --heuristic lmcutt", "did you mean 'lmcut'?"),
        ("top 2 d p --distinct sequense", "did you mean 'sequence'?"),
        ("plan d p --zzzzzz", "unknown option --zzzzzz (see 'statehtn plan --help')"),
        ("plan d p q", "unrecognized arguments: q"),
    ],
)
def test_what_was_meant(command: str, words: str, capsys: Capture) -> None:
    assert main(command.split()) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert words in captured.err
    assert captured.err.count("\n") == 1


def test_after_two_dashes_there_are_no_options(capsys: Capture) -> None:
    assert main(["plan", "--", "--no-such-file", "p"]) == 30
    assert "--no-such-file" in capsys.readouterr().err


def test_columns_are_as_wide_as_the_longest_name() -> None:
    lines = described({"a": "word " * 30, "a-name-that-is-long": "meaning"}).splitlines()
    column = len("  a-name-that-is-long  ")
    assert lines[-1] == "  a-name-that-is-long  meaning"
    assert lines[0].startswith("  a".ljust(column) + "word")
    assert all(line.startswith(" " * column) for line in lines[1:-1])


def test_every_heuristic_stands_apart_from_its_description(capsys: Capture) -> None:
    assert main(["plan", "--help"]) == 0
    text = capsys.readouterr().out
    assert "potential-hmax  the same" in text
    assert "\n  auto            three searches" in text
