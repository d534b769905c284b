"""Names are compared without case, and written as their declarations write them, wherever they come out."""

from __future__ import annotations

import json
import pickle
import re
from pathlib import Path

import pytest

import statehtn
from statehtn.cli.program import main
from statehtn.errors import InputError
from statehtn.hddl import HddlWarning, read_hddl_text, write_hddl
from statehtn.model import Problem, Step

WORDS = re.compile(r"\w+(?:-\w+)*")
DOMAIN = """(define (domain Harbour)
(:types Ship Pier - Thing)
(:constants Home - PIER)
(:predicates (At ?S - ship ?P - pier) (AT-SEA ?s - Ship))
(:functions (Miles ?From ?To - pier))
(:task Bring :parameters (?S - ship ?To - pier))
(:method M-Sail :parameters (?S - Ship ?From ?To - Pier) :task (bring ?s ?TO)
  :precondition (and (aT ?s ?FROM) (exists (?other - SHIP) (at ?OTHER ?from)))
  :ordered-subtasks (and (Go (SAIL ?s ?from ?to)) (Moor ?S)) :constraints (not (= ?FROM ?to)))
(:action Sail :parameters (?S - Ship ?From ?To - Pier) :precondition (AT ?s ?from)
  :effect (and (not (at ?S ?FROM)) (at ?s ?to) (forall (?S - thing) (when (sortof ?s - ship) (at-sea ?S)))
    (INCREASE (Total-Cost) (miles ?FROM ?to))))
(:action Moor :parameters (?s - Ship) :effect (not (At-Sea ?S))))"""
PROBLEM = """(Define (problem Monday) (:DOMAIN harbour)
(:Objects Anna BERTA - ship North - PIER)
(:HTN :Tasks (bring anna NORTH))
(:INIT (at ANNA home) (AT BERTA Home) (= (MILES home north) 1E1) (= (Miles north HOME) 1))
(:goal (at anna north)) (:metric MINIMIZE (TOTAL-COST)))"""
NAMES = set(
    WORDS.findall("Harbour Ship Pier Thing Home At AT-SEA Miles Bring M-Sail Sail Moor Monday Anna BERTA North")
)


@pytest.fixture
def harbour() -> Problem:
    return read_hddl_text(DOMAIN, PROBLEM, strict=True)


@pytest.fixture
def files(tmp_path: Path) -> tuple[str, str]:
    (tmp_path / "d.hddl").write_text(DOMAIN)
    (tmp_path / "p.hddl").write_text(PROBLEM)
    return str(tmp_path / "d.hddl"), str(tmp_path / "p.hddl")


def steps(problem: Problem) -> tuple[Step, ...]:
    plan = statehtn.plan(problem).plan
    assert plan is not None
    return plan.steps


def assert_spelt(text: str) -> None:
    """No name of the problem stands in a text in other letters than those of its declaration."""
    spelt = {name.lower(): name for name in NAMES}
    found = WORDS.findall(text)
    assert [word for word in found if word != spelt.get(word.lower(), word)] == []
    assert any(word in NAMES for word in found)


def test_case_does_not_matter(harbour: Problem) -> None:
    other = read_hddl_text(DOMAIN.lower(), PROBLEM.lower(), strict=True)
    assert repr(harbour.domain).lower() == repr(other.domain)
    assert read_hddl_text(DOMAIN, PROBLEM.lower().replace("monday", "Monday")).initial_state == {
        ("At", "anna", "Home"),
        ("At", "berta", "Home"),
    }
    assert [str(step).lower() for step in steps(harbour)] == [str(step) for step in steps(other)]


def test_everything_is_spelt_as_it_is_declared(harbour: Problem) -> None:
    domain = harbour.domain
    assert domain.types.parents == {"Ship": ("Thing",), "Pier": ("Thing",), "Thing": ()}
    assert harbour.all_objects == {"Home": "Pier", "Anna": "Ship", "BERTA": "Ship", "North": "Pier"}
    assert harbour.initial_state == {("At", "Anna", "Home"), ("At", "BERTA", "Home")}
    assert set(harbour.function_values) == {("Miles", "Home", "North"), ("Miles", "North", "Home")}
    method = domain.methods["M-Sail"]
    assert (method.task, method.arguments) == ("Bring", ("?S", "?To"))
    assert [(one.label, one.task, one.arguments) for one in method.network.subtasks] == [
        ("Go", "Sail", ("?S", "?From", "?To")),
        ("task0", "Moor", ("?S",)),
    ]
    texts = write_hddl(harbour)
    assert_spelt("".join(texts))
    assert read_hddl_text(*texts, strict=True) == harbour
    assert pickle.loads(pickle.dumps(harbour)) == harbour


def test_what_is_printed(
    harbour: Problem, files: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = statehtn.plan(harbour).plan
    assert plan is not None
    assert plan.steps == (Step("Sail", ("Anna", "Home", "North")), Step("Moor", ("Anna",)))
    assert_spelt(str(plan.decomposition))
    assert_spelt(statehtn.write_plan(plan, harbour))
    for command in ("plan", "plan --json", "plan --quiet", "top 2", "compare-attitudes"):
        assert main([*command.split(), *files]) == 0
        out = capsys.readouterr().out
        assert_spelt(out)
        if command == "plan --json":
            assert json.loads(out)["plan"][0]["action"] == "Sail"
    for suffix in ("dot", "graphml"):
        file = tmp_path / f"graph.{suffix}"
        assert main(["graph", *files, "--output", str(file)]) == 0
        assert_spelt(file.read_text())


@pytest.mark.parametrize("change", [str, str.lower, str.upper, str.swapcase])
def test_plans_are_read_in_any_case(harbour: Problem, change: type[str]) -> None:
    plan = statehtn.plan(harbour).plan
    assert plan is not None
    read = statehtn.read_plan(change(statehtn.write_plan(plan, harbour)), harbour)
    assert read.steps == plan.steps
    assert statehtn.validate(harbour, read).valid


def test_names_are_looked_up_in_any_case(harbour: Problem, tmp_path: Path) -> None:
    costs = tmp_path / "costs.toml"
    costs.write_text('[[costs]]\naction = "SAIL"\narguments = ["ANNA", "*", "north"]\ncost = 7\n')
    assert statehtn.plan(statehtn.read_costs(costs).apply(harbour)).expected_cost == 7
    priced = statehtn.with_cost(harbour, "moor", 5, when="(AT ?s home)")
    assert statehtn.plan(statehtn.with_cost(priced, "SAIL", lambda ship, *_: {"Anna": 2}[ship])).expected_cost == 2
    assert statehtn.plan(statehtn.with_cost(harbour, "Moor", 5, when="(AT ?s NORTH)")).expected_cost == 15


def test_names_of_different_kinds_do_not_clash() -> None:
    problem = read_hddl_text(
        """(define (domain AT) (:types At) (:predicates (aT ?AT - at)) (:functions (At ?at - AT))
        (:task AT :parameters (?at - At))
        (:method at :parameters (?aT - AT) :task (at ?AT) :precondition (AT ?At) :subtasks (AT (go ?at)))
        (:action Go :parameters (?At - at) :effect (and (not (AT ?aT)) (increase (total-cost) (AT ?AT)))))""",
        "(define (problem At) (:domain at) (:objects at - at) (:init (AT AT) (= (at At) 3)) (:htn :subtasks (at AT)))",
        strict=True,
    )
    plan = statehtn.plan(problem).plan
    assert plan is not None
    assert statehtn.write_plan(plan, problem).split("\n")[1:4] == ["0 Go at", "root 1", "1 AT at -> at 0"]
    other = statehtn.read_plan("==>\n0 GO AT\nroot 1\n1 at AT -> AT 0\n<==", problem)
    assert other == statehtn.read_plan(statehtn.write_plan(plan, problem), problem)


def problem_with(objects: str) -> str:
    return f"(define (problem p) (:objects {objects}) (:htn :subtasks ()))"


EMPTY = "(define (problem p) (:domain d) (:htn :subtasks ()))"
ONE = [
    ("(:types a) (:constants B b C - a)", EMPTY, "domain:1:45: 'b' and 'B' (line 1, column 43) differ in case only"),
    ("(:types a) (:constants B - a)", problem_with("b - A"), "problem:1:31: 'b' and 'B' (domain:1:43)"),
    ("(:types A - b a - B)", EMPTY, "domain:1:34: 'a' and 'A' (line 1, column 28) differ in case only"),
    ("(:predicates (P ?x) (p ?y))", EMPTY, "domain:1:41: 'p' and 'P' (line 1, column 34)"),
    ("(:functions (F ?x) (f ?x))", EMPTY, "domain:1:40: 'f' and 'F' (line 1, column 33)"),
    ("(:predicates (p ?X ?x))", EMPTY, "domain:1:39: variable '?x' is declared twice in one list (as '?X'"),
]
OTHER = [
    ("(:types a b) (:constants O - a o - b)", EMPTY, "domain:1:51: 'o' and 'O' (line 1, column 45) differ in case"),
    ("(:types a b) (:constants O - a)", problem_with("o - b"), "problem:1:31: 'o' and 'O' (domain:1:45) differ in"),
    ("(:types A - b a - c)", EMPTY, "domain:1:34: 'a' and 'A' (line 1, column 28) differ in case only"),
    ("(:predicates (P ?x) (p))", EMPTY, "domain:1:41: 'p' and 'P' (line 1, column 34)"),
    ("(:functions (F ?x) (f))", EMPTY, "domain:1:40: 'f' and 'F' (line 1, column 33)"),
    ("(:task T) (:task t)", EMPTY, "domain:1:37: 't' and 'T' (line 1, column 27)"),
    ("(:task T) (:action t)", EMPTY, "domain:1:39: 't' and 'T' (line 1, column 27)"),
    ("(:task t) (:method M :task (t)) (:method m :task (t))", EMPTY, "domain:1:61: 'm' and 'M' (line 1, column 39)"),
    ("(:task t :parameters (?X ?x))", EMPTY, "domain:1:45: variable '?x' is declared twice in one list (as '?X'"),
    ("(:task t) (:method m :task (t) :tasks (and (L (t)) (l (t))))", EMPTY, "domain:1:72: label 'l' stands twice"),
]


@pytest.mark.parametrize(("sections", "problem", "message"), ONE, ids=range(len(ONE)))
def test_names_that_differ_in_case_are_one_name(sections: str, problem: str, message: str) -> None:
    domain = f"(define (domain d) {sections})"
    with pytest.warns(HddlWarning) as caught:
        read_hddl_text(domain, problem)
    assert [str(one.message)[: len(message)] for one in caught] == [message]
    with pytest.raises(InputError, match=re.escape(message)):
        read_hddl_text(domain, problem, strict=True)


@pytest.mark.parametrize(("sections", "problem", "message"), OTHER, ids=range(len(OTHER)))
def test_different_things_whose_names_differ_in_case_are_an_error(sections: str, problem: str, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        read_hddl_text(f"(define (domain d) {sections})", problem)


def test_an_object_that_only_the_problem_declares_is_spelt_as_there() -> None:
    domain = """(define (domain d) (:types a) (:predicates (p ?x - a)) (:task t)
    (:method m :task (t) :precondition (p HOME) :subtasks ()))"""
    problem = "(define (problem p) (:objects Home other - A) (:init (p hOME)) (:htn :subtasks (t)))"
    with pytest.warns(HddlWarning, match="'Home' is an object of the problem"):
        found = read_hddl_text(domain, problem)
    assert found.domain.constants == {"Home": "a"}
    assert found.initial_state == {("p", "Home")}


def test_mistakes_are_told_as_they_are_written() -> None:
    with pytest.raises(InputError, match="unknown type 'Shp'; did you mean 'SHIP'"):
        read_hddl_text("(define (domain d) (:types SHIP) (:constants A - Shp))", EMPTY)


def test_the_builder_keeps_case() -> None:
    build = statehtn.ProblemBuilder("Monday", "Harbour")
    ship, pier = build.type("Ship"), build.type("Pier")
    (anna,) = ship.objects("Anna")
    (home,) = pier.objects("Home")
    at = build.predicate("At", *ship.variables("S"), *pier.variables("P"))
    bring = build.task("Bring", *ship.variables("S"), *pier.variables("P"))
    s, p = ship.variable("S"), pier.variable("P")
    sail = build.action("Sail", (s, p), effects=at(s, p))
    build.method("M-Sail", bring(s, p), sail(s, p))
    build.set_network(bring(anna, home))
    problem = build.build()
    assert list(map(str, steps(problem))) == ["(Sail Anna Home)"]
    assert read_hddl_text(*write_hddl(problem), strict=True) == problem
    build.set_cost("SAIL", 3)
    assert statehtn.plan(build.build()).expected_cost == 3
