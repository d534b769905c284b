"""Slips of the pen: missing spaces, commas, and characters that no name has."""

from __future__ import annotations

import pytest

from statehtn.errors import InputError
from statehtn.hddl import HddlWarning, read_hddl_text

DOMAIN = """(define (domain d) ; a?b, here, means nothing
(:types car - vehicle place)
(:predicates (at ?v - vehicle ?p - place))
(:task go :parameters (?v - vehicle ?p - place))
(:action move :parameters (?v - car ?p ?q - place)
 :precondition (at ?v ?p) :effect (and (at ?v ?q) (forall (?x - place) (when (not (= ?x ?q)) (not (at ?v ?x))))))
(:method m :parameters (?v - car ?p ?q - place) :task (go ?v ?q)
 :precondition (at ?v ?p) :subtasks (move ?v ?p ?q)))"""
PROBLEM = """(define (problem p) (:objects c - car a b - place)
(:htn :parameters (?x - place) :subtasks (go c ?x)) (:init (at c a)))"""
SPACES = [
    ("(at ?v - vehicle", "(at?v - vehicle", "3:17: expected a space before '?v'"),
    ("move :parameters (?v - car ?p ?q", "move :parameters (?v - car ?p?q", "5:39: expected a space before '?q'"),
    (":precondition (at ?v ?p) :subtasks", ":precondition (at?v ?p) :subtasks", "8:19: expected a space before '?v'"),
    ("(move ?v ?p ?q)", "(move?v?p?q)", "8:42: expected a space before '?v'"),
    ("(= ?x ?q)", "(=?x?q)", "6:85: expected a space before '?x'"),
    ("forall (?x", "forall(?x", ""),
    ("?p - place))\n(:task", "?p- place))\n(:task", "3:31: expected a space before '-', found '?p-'"),
    ("car - vehicle", "car- vehicle", "2:9: expected a space before '-', found 'car-'"),
]


@pytest.mark.parametrize(("old", "new", "message"), SPACES, ids=range(len(SPACES)))
@pytest.mark.filterwarnings("ignore::statehtn.hddl.HddlWarning")
def test_a_missing_space_is_told_and_seen_through(old: str, new: str, message: str) -> None:
    assert DOMAIN.count(old) == 1
    text = DOMAIN.replace(old, new)
    assert read_hddl_text(text, PROBLEM) == read_hddl_text(DOMAIN, PROBLEM)
    if message:
        with pytest.warns(HddlWarning) as caught:
            read_hddl_text(text, PROBLEM)
        assert str(caught[0].message) == f"domain:{message}"
        with pytest.raises(InputError, match="expected a space before"):
            read_hddl_text(text, PROBLEM, strict=True)


def test_missing_spaces_in_objects_of_a_problem() -> None:
    problem = PROBLEM.replace("c - car a b - place", "c- car a b - place")
    with pytest.warns(HddlWarning, match=r"problem:1:31: expected a space before '-', found 'c-'"):
        assert read_hddl_text(DOMAIN, problem) == read_hddl_text(DOMAIN, PROBLEM)
    with pytest.warns(HddlWarning, match=r"problem:2:47: expected a space before '\?x'"):
        assert read_hddl_text(DOMAIN, PROBLEM.replace("c ?x", "c?x")) == read_hddl_text(DOMAIN, PROBLEM)


def test_a_question_mark_at_the_end_of_a_name_is_a_part_of_it() -> None:
    domain = "(define (domain d) (:predicates (clear? ?x)) (:task t) (:method m :task (t) :precondition (clear? b)))"
    with pytest.warns(HddlWarning, match="'b' is an object of the problem"):
        read = read_hddl_text(domain, "(define (problem p) (:objects b) (:init (clear? b)) (:htn :subtasks (t)))")
    assert read.initial_state == {("clear?", "b")}


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("car - vehicle place", "car - vehicle, place", "2:22"),
        ("car - vehicle place", "car , place", "2:13"),
        ("(at ?v ?p) :effect", "(at ?v,?p) :effect", "6:22"),
        ("(move ?v ?p ?q)", "(move ?v ?p ?q,)", "8:51"),
    ],
)
def test_commas(old: str, new: str, place: str) -> None:
    with pytest.raises(InputError, match=rf"^domain:{place}: a comma has no meaning in HDDL; expected spaces"):
        read_hddl_text(DOMAIN.replace(old, new), PROBLEM)


@pytest.mark.parametrize("character", ["\x1b", "\x07", "\u200b", "\u202e", "\x9b", "\ufeff", "\xad", "\x7f"])
def test_characters_that_are_not_seen(character: str) -> None:
    """They would drive the terminal wherever the name is printed."""
    with pytest.raises(InputError, match=rf"^problem:1:34: the character U\+{ord(character):04X} cannot be seen"):
        read_hddl_text(DOMAIN, PROBLEM.replace("(:objects c", f"(:objects loc{character}[31m"))
    read_hddl_text(f"; {character}, in a comment\n{DOMAIN}", PROBLEM, strict=True)


@pytest.mark.parametrize("name", ["o'brien", '"b"', "m[1]", "{x}", "a\\b"])
def test_odd_characters_in_names(name: str) -> None:
    problem = f"(define (problem p) (:objects c - car {name} b - place) (:htn :subtasks (go c {name})))"
    with pytest.warns(HddlWarning, match="problem:1:39: no name in HDDL has a .* other programs will not read it"):
        assert name in read_hddl_text(DOMAIN, problem).objects
