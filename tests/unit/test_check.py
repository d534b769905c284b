"""What `statehtn check` says of models, and in which form."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import statehtn
from statehtn.cli.program import main
from statehtn.inspection import CODES, Level, check
from tests.pages import ROOT

DOMAIN = """(define (domain d)
  (:types t)
  (:predicates (p ?x - t) (q))
  (:task go :parameters (?x - t))
  (:method m :parameters (?x - t) :task (go ?x) :precondition (p ?x) :ordered-subtasks (and (act ?x)))
  (:action act :parameters (?x - t) :precondition (q) :effect (and (p ?x) (q))))
"""
PROBLEM = "(define (problem p) (:domain d) (:objects a - t) (:htn :subtasks (go a)) (:init (p a) (q)))"


@pytest.fixture(autouse=True)
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("domain.hddl").write_text(DOMAIN, encoding="utf-8")
    Path("problem.hddl").write_text(PROBLEM, encoding="utf-8")


def mutated(old: str, new: str) -> None:
    assert old in DOMAIN
    Path("domain.hddl").write_text(DOMAIN.replace(old, new), encoding="utf-8")


def test_a_sound_model_has_no_findings(capsys: pytest.CaptureFixture[str]) -> None:
    assert check("domain.hddl") == check("domain.hddl", "problem.hddl") == []
    assert main(["check", "domain.hddl", "problem.hddl"]) == 0
    assert capsys.readouterr().out == "nothing to say: no errors, no warnings, no notes\n"


@pytest.mark.parametrize("domain", sorted((ROOT / "domains").glob("*/domain.hddl")), ids=lambda path: path.parent.name)
def test_our_own_domains_have_none(domain: Path) -> None:
    assert check(domain) == []


def test_what_stands_in_outcomes_is_used() -> None:
    mutated("(:task go", "(:functions (chance ?x - t) - number)\n  (:task go")
    text = Path("domain.hddl").read_text(encoding="utf-8")
    outcomes = "(probabilistic (chance ?x) (and (p ?x) (q)) (- 1 (chance ?x)) ())"
    Path("domain.hddl").write_text(text.replace("(and (p ?x) (q))", outcomes), encoding="utf-8")
    assert check("domain.hddl") == []
    assert [finding.code for finding in check("domain.hddl", "problem.hddl")] == ["no-value"]


def test_a_finding_says_what_where_and_what_to_do(capsys: pytest.CaptureFixture[str]) -> None:
    mutated(":precondition (q)", ":precondition (and (q) (not (q)))")
    (finding,) = statehtn.check("domain.hddl")
    assert (finding.level, finding.code, finding.about) == (Level.WARNING, "contradiction", ("action", "act"))
    assert (finding.place.file, finding.place.line, finding.place.column) == ("domain.hddl", 6, 65)
    assert main(["check", "domain.hddl"]) == 1
    first, last = capsys.readouterr().out.splitlines()
    assert first.startswith("domain.hddl:6:65: warning: the precondition of action 'act' never holds")
    assert last == "0 errors, 1 warning, 0 notes"


def test_other_forms(capsys: pytest.CaptureFixture[str]) -> None:
    mutated(":precondition (q)", ":precondition (and (q) (not (q)))")
    assert main(["check", "domain.hddl", "--format", "json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert (found["errors"], found["warnings"], found["notes"], found["problem"]) == (0, 1, 0, None)
    assert found["findings"][0]["line"] == 6
    assert set(found["findings"][0]) == {"level", "file", "line", "column", "message", "advice", "code"}
    assert main(["check", "domain.hddl", "--format", "github"]) == 1
    line = capsys.readouterr().out
    assert line.startswith("::warning file=domain.hddl,line=6,col=65,title=contradiction::the precondition of action")


def test_what_is_refused_is_a_finding_and_reading_goes_on() -> None:
    mutated("(p ?x) (q))))", "(p ?y) (q)))\n  (:action other :parameters () :precondition (r) :effect ()))")
    findings = check("domain.hddl", "problem.hddl")
    assert [(finding.level, finding.code, finding.place.line) for finding in findings] == [
        (Level.ERROR, "undefined", 6),
        (Level.ERROR, "undefined", 7),
    ]


def test_what_cannot_be_read_at_all_is_none(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "nowhere.hddl"]) == 30
    assert main(["check", "domain.hddl", "nowhere.hddl"]) == 30
    Path("domain.hddl").write_bytes(b"\0")
    assert main(["check", "domain.hddl"]) == 30
    Path("domain.hddl").write_text("(define (domain d", encoding="utf-8")
    assert main(["check", "domain.hddl"]) == 1
    assert "domain.hddl:1:9: error: unbalanced parentheses" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("block", "advice"),
    [
        ("-0.5 (q) 0.5 ()", "probabilities are numbers from 0 to 1"),
        ("-0.5 (increase (total-cost) 1)", "probabilities are numbers from 0 to 1"),
        ("0.5 (q) 0.5", "write a probability before each part, as in 0.3 (..) 0.7 (..)"),
        ("0.9 (q) 0.8 ()", "make the probabilities of the block sum to 1"),
        ("0.9 (q)", "make the probabilities of the block sum to 1"),
    ],
)
def test_advice_on_probabilities_helps_with_what_is_wrong(block: str, advice: str) -> None:
    mutated("(p ?x) (q))))", f"(p ?x) (probabilistic {block}))))")
    assert [(finding.code, finding.advice) for finding in check("domain.hddl")] == [("probabilities", advice)]


@pytest.mark.parametrize(("value", "shown"), [("-0.5", ["-0.5"]), ("1.5", ["1.5"]), ("1", []), ("0", [])])
def test_values_that_are_no_probabilities(value: str, shown: list[str]) -> None:
    mutated("(:task go", "(:functions (chance ?x - t) - number)\n  (:task go")
    text = Path("domain.hddl").read_text(encoding="utf-8")
    outcomes = "(probabilistic (chance ?x) (and (p ?x) (q)))"
    Path("domain.hddl").write_text(text.replace("(and (p ?x) (q))", outcomes), encoding="utf-8")
    Path("problem.hddl").write_text(PROBLEM.replace("(:init", f"(:init (= (chance a) {value})"), encoding="utf-8")
    said = [f for f in check("domain.hddl", "problem.hddl") if f.code == "probabilities"]
    assert [finding.message for finding in said] == [
        f"':init' gives (chance a) the value {each}, a probability in action 'act'" for each in shown
    ]


def test_an_object_that_only_a_problem_declares() -> None:
    mutated("(act ?x)", "(act b)")
    (finding,) = check("domain.hddl")
    assert (finding.level, finding.code) == (Level.WARNING, "undefined")
    assert "'b'" in finding.message
    problem = PROBLEM.replace("(:objects a", "(:objects a b")
    Path("problem.hddl").write_text(problem, encoding="utf-8")
    assert [finding.level for finding in check("domain.hddl", "problem.hddl")] == [Level.WARNING]


def test_without_a_problem_nothing_is_said_that_one_could_decide() -> None:
    mutated("(p ?x) (q))", "(p ?x))")  # nothing makes (q) true but a problem
    mutated("(:task go", "(:task other :parameters ())\n  (:method o :parameters () :task (other))\n  (:task go")
    assert check("domain.hddl") == []


def test_the_page_has_every_code() -> None:
    page = (ROOT / "docs" / "check.md").read_text(encoding="utf-8")
    for code, meaning in CODES.items():
        assert f"| `{code}` | {meaning} |" in page


OUTCOMES = """(define (domain d)
  (:types t)
  (:predicates (dry ?x - t) (clean ?x - t) (broken ?x - t))
  (:task tidy :parameters (?x - t))
  (:method m :parameters (?x - t) :task (tidy ?x) :ordered-subtasks (and (wash ?x) (hang ?x) (look ?x)))
  (:action wash :parameters (?x - t) :precondition (not (broken ?x))
    :effect (probabilistic 0.5 (clean ?x) 0.5 (broken ?x)))
  (:action hang :parameters (?x - t) :precondition (clean ?x)
    :effect (probabilistic 0.5 (dry ?x) 0.5 (not (clean ?x))))
  (:action look :parameters (?x - t) :precondition (and (dry ?x) (not (clean ?x))) :effect ()))
"""


def test_whatever_an_outcome_brings_can_come() -> None:
    Path("domain.hddl").write_text(OUTCOMES, encoding="utf-8")
    problem = "(define (problem p) (:domain d) (:objects a - t) (:htn :subtasks (tidy a)) (:init))"
    Path("problem.hddl").write_text(problem, encoding="utf-8")
    assert check("domain.hddl", "problem.hddl") == []
    Path("domain.hddl").write_text(OUTCOMES.replace("0.5 (dry ?x)", "0.5 (clean ?x)"), encoding="utf-8")
    first = check("domain.hddl", "problem.hddl")[0]
    assert (first.level, first.code, first.about) == (Level.ERROR, "never-true", ("fact", "dry"))
