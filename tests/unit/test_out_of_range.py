"""Numbers out of all ranges, and slips whose messages say what to write."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import statehtn
from statehtn.cli import main
from statehtn.risk import utility_for

DOMAIN = """
(define (domain d) (:requirements :hierarchy) (:types TYPES) (:predicates (there) (wet ?b - box))
  (:functions (total-cost) (fare))
  (:action go :parameters (PARAMETERS) :effect (and (there) COST)))
"""
PROBLEM = "(define (problem p) (:domain d) (:htn :subtasks (go)) (:init INIT))"


def read(cost: str = "", init: str = "", types: str = "box", parameters: str = "") -> statehtn.Problem:
    domain = DOMAIN.replace("COST", cost).replace("TYPES", types).replace("PARAMETERS", parameters)
    return statehtn.read_hddl_text(domain, PROBLEM.replace("INIT", init))


@pytest.mark.parametrize("number", ["1e400", "-1e400", "1e-400", "1e999999999", "1e-999999999", "9" * 5000])
def test_numbers_out_of_range_are_told_as_such(number: str) -> None:
    for cost, init in ((f"(increase (total-cost) {number})", ""), ("", f"(= (fare) {number})")):
        with pytest.raises(statehtn.InputError, match=f"the number '{number[:40]}.*is out of range") as error:
            read(cost, init)
        assert error.value.place is not None


@pytest.mark.parametrize("word", ["1/0", "1e", "e5", "--1", "1.2.3", "nan", "fare"])
def test_other_words_are_no_numbers(word: str) -> None:
    with pytest.raises(statehtn.InputError, match=r"expected a number"):
        read(init=f"(= (fare) {word})")


def test_zero_and_the_ends_of_the_range_are_read() -> None:
    assert statehtn.plan(read("(increase (total-cost) 0.0)")).risk_cost == 0
    for number in (5e-324, 1e-300, 1e289):
        assert statehtn.plan(read(f"(increase (total-cost) {number!r})")).risk_cost == pytest.approx(number, abs=0)


@pytest.mark.parametrize(
    ("effect", "hint"),
    [
        ("(when (there) (increase (total-cost) 1))", r"\(when <condition> \(probabilistic"),
        ("(forall (?b - box) (increase (total-cost) 1))", r"\(forall \(<variables>\) \(probabilistic"),
        ("(probabilistic 0.2 (increase (total-cost) 1))", "products of the probabilities"),
    ],
)
def test_what_stands_inside_a_probabilistic_block(effect: str, hint: str) -> None:
    with pytest.raises(statehtn.UnsupportedError, match=hint):
        read(f"(probabilistic 0.5 {effect})")


def test_slips_of_spacing_in_typed_lists_are_named() -> None:
    with pytest.warns(UserWarning, match="'box:place' is one name"):
        read(types="box box:place")
    with pytest.raises(statehtn.InputError, match=r"found '\?', alone; is there a space too many behind it"):
        read(parameters="? - box")


def test_values_in_side_files_stand_as_these_write_them(tmp_path: Path) -> None:
    file = tmp_path / "costs.json"
    for text, shown in (
        ('{"costs": null}', "null"),
        ('{"costs": [{"action": true, "cost": 1}]}', "true"),
        ("[]", "[]"),
    ):
        file.write_text(text)
        with pytest.raises(statehtn.InputError, match=f"found {shown}".replace("[", r"\[")):
            statehtn.read_costs(file)


def test_a_law_with_too_many_outcomes_says_how_many_in_short() -> None:
    stats = pytest.importorskip("scipy.stats")
    with pytest.raises(statehtn.StateHtnError, match=r"has 1e\+308 outcomes"):
        statehtn.CostDistribution.from_scipy(stats.binom(n=1e308, p=0.5))


def test_an_expected_utility_of_any_size_is_short() -> None:
    assert utility_for("averse", 1.0).expected_utility_text(1e280).startswith("-10^4.34")
    assert utility_for("seeking", 1.0).expected_utility_text(1e280).startswith("10^-4.34")
    assert len(utility_for("averse", 1.0).expected_utility_text(1e280)) < 40


def test_graphs_on_standard_output_need_a_format(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["graph", "d.hddl", "p.hddl", "--output", "-"]) == 2
    assert "--output - needs --format beside it: svg, dot or graphml" in capsys.readouterr().err


@pytest.mark.parametrize("command", [["plan"], ["top", "1"]])
def test_quiet_plans_are_utf_8_whatever_the_encoding(tmp_path: Path, command: list[str]) -> None:
    (tmp_path / "d.hddl").write_text("(define (domain d) (:predicates (p)) (:action fährt :parameters () :effect (p)))")
    (tmp_path / "p.hddl").write_text("(define (problem p) (:domain d) (:htn :subtasks (fährt)) (:init))")
    arguments = [sys.executable, "-m", "statehtn", *command, "d.hddl", "p.hddl", "--quiet"]
    environment = os.environ | {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}
    ended = subprocess.run(arguments, cwd=tmp_path, env=environment, capture_output=True, timeout=120, check=False)
    assert (ended.returncode, ended.stdout.decode()) == (0, "(fährt)\n")


def test_without_any_plan_agents_are_compared_in_short() -> None:
    problem = statehtn.read_hddl_text(
        DOMAIN.replace("COST", "").replace("TYPES", "box").replace("PARAMETERS", ""),
        PROBLEM.replace("(:init INIT)", "(:init) (:goal (not (there)))"),
    )
    text = str(statehtn.compare_attitudes(problem, [1.0]))
    assert text.count("unsolvable") == 3
    assert "certainty equivalent" not in text
    assert "most" not in text
