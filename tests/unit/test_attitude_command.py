"""`statehtn attitude`: alpha from what is said on the command line."""

from __future__ import annotations

import json

import pytest

from statehtn import CostDistribution
from statehtn.cli import main

LOTTERY = "0.5:5 0.5:30"
LAW = CostDistribution.of([(0.5, 5), (0.5, 30)])


def told(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, object]:
    assert main(["attitude", *arguments, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert isinstance(found, dict)
    return found


def test_the_alpha_of_an_indifferent_person(capsys: pytest.CaptureFixture[str]) -> None:
    found = told(capsys, "--certain", "19.4", "--lottery", LOTTERY)
    assert found["alpha_from"] == found["alpha_to"] == found["alpha"]
    assert LAW.exponential_mean(float(str(found["alpha"]))) == pytest.approx(19.4, rel=1e-9)
    assert main(["attitude", "--certain", "19.4", "--lottery", LOTTERY]) == 0
    assert capsys.readouterr().out == (
        "averse 0.0247029 (alpha 0.0247029)\nas an agent: --attitude averse --alpha 0.0247029\n"
    )
    assert told(capsys, "--certain", "17.5", "--lottery", LOTTERY)["alpha"] == 0
    assert float(str(told(capsys, "--certain", "10", "--lottery", LOTTERY)["alpha"])) < 0


def test_preferences_are_ends_of_an_interval(capsys: pytest.CaptureFixture[str]) -> None:
    averse = told(capsys, "--prefer", f"19.4 over {LOTTERY}")
    assert averse["alpha_to"] is averse["alpha"] is None
    assert LAW.exponential_mean(float(str(averse["alpha_from"]))) == pytest.approx(19.4, rel=1e-9)
    both = told(capsys, "--prefer", f"19.4 over {LOTTERY}", "--prefer", f"{LOTTERY} over 22")
    assert both["alpha_from"] == averse["alpha_from"]
    assert LAW.exponential_mean(float(str(both["alpha_to"]))) == pytest.approx(22, rel=1e-9)


def test_contradictions_are_named(capsys: pytest.CaptureFixture[str]) -> None:
    statements = ("--certain", "19.4", "--lottery", LOTTERY, "--prefer", f"{LOTTERY} over 12")
    found = told(capsys, *statements)
    assert (found["contradictions"], found["alpha"]) == ([[1, 2]], None)
    assert main(["attitude", *statements]) == 0
    assert "no alpha fits all answers (contradictory are 1 and 2)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        ([], 2, "nothing was said"),
        (
            ["--certain", "3"],
            2,
            "--certain and --lottery belong together, the first to the first and so on, found 1 and 0",
        ),
        (["--certain", "3", "--lottery", "5 30"], 2, "a lottery is written as in '0.5:5 0.5:30'"),
        (["--certain", "3", "--lottery", "0.5:5 0.6:30"], 2, "must sum to 1, found 1.1"),
        (["--certain", "31", "--lottery", LOTTERY], 30, "give one above 5 and below 30"),
        (["--certain", "5", "--lottery", "1:5"], 30, "it says nothing about an attitude"),
        (["--prefer", "3 over 4"], 2, "a preference is a certain cost over a lottery"),
        (["--prefer", f"much over {LOTTERY}"], 2, "is no number"),
        (["--prefer", f"40 over {LOTTERY}"], 2, "nobody prefers that, whatever they think of risk"),
        (["--prefer", f"{LOTTERY} over 40"], 2, "everybody prefers that, whatever they think of risk"),
        (["--prefer", f"1 over {LOTTERY}"], 2, "everybody prefers that, whatever they think of risk"),
        (["--prefer", LOTTERY], 2, "a preference is a certain cost over a lottery"),
    ],
)
def test_what_is_wrong_is_said(
    arguments: list[str], code: int, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["attitude", *arguments]) == code
    captured = capsys.readouterr()
    assert message in captured.err
    assert captured.err.count("\n") == 1
    assert captured.out == ""
