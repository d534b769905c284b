"""What no plan can get past is told when a problem is read."""

from __future__ import annotations

import re
import warnings

import pytest

from statehtn.errors import InputError
from statehtn.hddl import HddlWarning, read_hddl_text

DOMAIN = """(define (domain d) (:types ware shop)
(:predicates (stored ?w - ware ?s - shop) (sold ?w - ware) (packed ?w - ware))
(:task deliver :parameters (?w - ware))
(:task wrap :parameters (?w - ware))
(:method m-plain :parameters (?w - ware) :task (deliver ?w) :subtasks (sell ?w))
(:method m-nice :parameters (?w - ware) :task (deliver ?w) :ordered-subtasks (and (wrap ?w) (sell ?w)))
(:method m-wrap :parameters (?w - ware) :task (wrap ?w) :subtasks (pack ?w))
(:action sell :parameters (?w - ware) :effect (sold ?w))
(:action pack :parameters (?w - ware) :precondition (not (packed ?w)) :effect (packed ?w)))"""
PROBLEM = """(define (problem p) (:objects tea - ware here - shop)
(:htn :subtasks (deliver tea)) (:init (stored tea here))
(:goal (and (sold tea) (stored tea here))))"""


def test_nothing_is_told_of_what_is_fine() -> None:
    read_hddl_text(DOMAIN, PROBLEM, strict=True)


CASES = [
    # a task without a method
    (
        "(:method m-wrap :parameters (?w - ware) :task (wrap ?w) :subtasks (pack ?w))",
        "",
        "d.hddl:4:8: task 'wrap' has no method, so that method 'm-nice', where it stands, leads to no plan",
    ),
    (
        "(deliver tea)",
        "(and (deliver tea) (extra))",
        "d.hddl:3:8: task 'extra' has no method, so that the init",
    ),
    # goals
    (":effect (sold ?w)", "", "p.hddl:3:13: neither ':init' nor an action makes (sold tea) true: there is no plan"),
    ("(stored tea here))))", "(Stored TEA here) (exists (?w - ware) (packed ?w)))))", None),
    ("(:init (stored tea here))", "", "p.hddl:3:24: neither ':init' nor an action makes (stored tea here) true"),
    # preconditions
    (
        "sell :parameters (?w - ware)",
        "sell :parameters (?w - ware) :precondition (and (exists (?s - shop) (and (ready) (stored ?w ?s))))",
        "d.hddl:8:10: action 'sell' needs (ready), but neither ':init' nor an action makes any fact of 'ready' true",
    ),
    ("m-nice :parameters (?w - ware)", "m-nice :parameters (?w - ware) :precondition (ready)", None),
    ("m-plain :parameters (?w - ware)", "m-plain :parameters (?w - ware) :precondition (or (ready) (sold ?w))", None),
    ("not (packed ?w)", "ready", None),
]


@pytest.mark.parametrize(("old", "new", "message"), CASES, ids=range(len(CASES)))
def test_dead_ends(old: str, new: str, message: str | None) -> None:
    domain, problem = (text.replace(old, new) for text in (DOMAIN, PROBLEM))
    assert (domain, problem) != (DOMAIN, PROBLEM)
    domain = domain.replace("(:predicates", "(:predicates (ready)").replace("(:task d", "(:task extra) (:task d")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        read_hddl_text(domain, problem, domain_file="d.hddl", problem_file="p.hddl")
    assert [str(one.message)[: len(message or "")] for one in caught] == ([] if message is None else [message])
    if message is not None:
        with pytest.raises(InputError, match=re.escape(message)):
            read_hddl_text(domain, problem, strict=True, domain_file="d.hddl", problem_file="p.hddl")


def test_both_methods_lack_something() -> None:
    domain = DOMAIN.replace("(:predicates", "(:predicates (open) (ready)")
    domain = domain.replace("m-plain :parameters (?w - ware)", "m-plain :parameters (?w - ware) :precondition (open)")
    domain = domain.replace("not (packed ?w)", "ready")
    with pytest.warns(HddlWarning) as caught:
        read_hddl_text(domain, PROBLEM)
    assert [str(one.message).split(" needs ")[0] for one in caught] == [
        "domain:9:10: action 'pack'",
        "domain:5:10: method 'm-plain'",
    ]
