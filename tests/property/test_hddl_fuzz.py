"""Damaged files give a result or an error of ours, never a crash or a hang."""

from __future__ import annotations

import os
import random
import warnings
from itertools import islice
from pathlib import Path

import pytest

from statehtn.errors import StateHtnError
from statehtn.hddl import HddlWarning, read_hddl, read_hddl_text
from statehtn.limits import Limits

DOMAIN = """(define (domain ferry)
  (:requirements :typing :hierarchy :action-costs :probabilistic-effects)
  (:types car boat - vehicle amphibian - car amphibian - boat place)
  (:constants home - place)
  (:predicates (at ?v - (either car boat) ?p - place) (on ?c - car ?b - boat) (foggy))
  (:functions (total-cost) - number (distance ?a ?b - place) - number (chance) - number)
  (:task bring :parameters (?c - car ?p - place))
  (:method m-by-boat :parameters (?c - car ?b - boat ?from ?to - place) :task (bring ?c ?to)
    :precondition (and (at ?c ?from) (not (= ?from ?to)) (exists (?x - boat) (at ?x ?from)))
    :subtasks (and (t1 (board ?c ?b)) (t2 (sail ?b ?from ?to)) (t3 (bring ?c ?to)))
    :ordering (and (< t1 t2) (< t2 t3)) :constraints (and (not (= ?from home)) (sortof ?b - boat)))
  (:method m-there :parameters (?c - car ?to - place) :task (bring ?c ?to) :precondition (at ?c ?to) :subtasks ())
  (:action board :parameters (?c - car ?b - boat) :precondition () :effect (and (on ?c ?b) (increase (total-cost) 1.5)))
  (:action sail :parameters (?b - boat ?a ?z - place) :precondition (at ?b ?a)
    :effect (and (at ?b ?z) (not (at ?b ?a)) (probabilistic 0.9 (increase (total-cost) (distance ?a ?z)) 0.1 ())
      (probabilistic (chance) (increase (total-cost) (* 2 (distance ?a ?z))) (- 1 (chance)) (and))
      (when (foggy) (increase (total-cost) 3))
      (forall (?c - car) (when (on ?c ?b) (and (at ?c ?z) (not (on ?c ?b))))))))
"""
PROBLEM = """(define (problem ferry-1) (:domain ferry)
  (:objects mini - car barge - boat duck - amphibian isle - place)
  (:htn :parameters (?p - place) :ordered-subtasks (and (bring mini ?p) (bring duck home))
    :constraints (not (= ?p home)))
  (:init (at mini home) (at barge home) (at duck isle) (foggy) (= (distance home isle) 12) (= (distance isle home) 1e1)
    (= (chance) 0.25) (= (total-cost) 0))
  (:goal (and (foggy) (forall (?c - car) (or (at ?c home) (at ?c isle))))) (:metric minimize (total-cost)))
"""
FRAGMENTS = (
    "(", ")", "()", "((", "))", "-", "?", "?x", ":", ":task", ":parameters", "and", "not", "(not", "either", "=", "<",
    "1/0", "1e400", "-1", "0.7", "nan", "inf", "probabilistic", "(when", "(forall (?x)", "increase", "(= home home)",
    ";", "define", "\u0130", "\u00a0", "\u2028", "\r", "\t", "''", '"', "\\", "object",
    "total-cost", "\ud7ff", "9" * 3000,
)  # fmt: skip
REPETITIONS = 400


def texts() -> list[tuple[str, str]]:
    """Return the texts to damage: the two above, and small ones of the repository and the competition."""
    found = [(DOMAIN, PROBLEM)]
    own = sorted((Path(__file__).parents[2] / "domains").glob("*/domain.hddl"))
    ipc = os.environ.get("STATEHTN_IPC")
    theirs = sorted(Path(ipc).glob("*/*/domain.hddl")) if ipc else []
    for domain in own + theirs:
        candidates = (path for path in sorted(domain.parent.glob("*.hddl")) if path != domain)
        problem = next((path for path in candidates if path.stat().st_size < 20_000), None)
        if problem and domain.stat().st_size < 20_000:
            found.append((domain.read_text(encoding="utf-8"), problem.read_text(encoding="utf-8")))
    return found


def damage(text: str, random_source: random.Random) -> str:
    """Change a text in one or two places."""
    for _ in range(random_source.choice((1, 1, 1, 2, 5))):
        words = text.split(" ")
        first, second = sorted(random_source.randrange(len(text) + 1) for _ in range(2))
        second = min(second, first + random_source.choice((1, 3, 20, 200, len(text))))
        where, other = random_source.randrange(len(words)), random_source.randrange(len(words))
        match random_source.randrange(7):
            case 0:
                text = text[:first]
            case 1:
                text = text[:first] + text[second:]
            case 2:
                text = text[:second] + text[first:]
            case 3:
                text = text[:first] + random_source.choice(FRAGMENTS) + text[first:]
            case 4:
                words[where] = random_source.choice((*FRAGMENTS, words[other]))
                text = " ".join(words)
            case 5:
                words[where], words[other] = words[other], words[where]
                text = " ".join(words)
            case _:
                random_source.shuffle(words) if random_source.random() < 0.1 else words.pop(where)
                text = " ".join(words)
    return text


def attempt(domain: str, problem: str) -> None:
    limits = Limits.starting_now(time_limit=10.0)  # `LimitReached` is not an error of the input: a hang fails the test
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HddlWarning)
        try:
            read_hddl_text(domain, problem, limits=limits)
        except StateHtnError as error:
            assert error.place is not None  # noqa: PT017
            assert "\n" not in error.message  # noqa: PT017


def test_the_texts_are_fine_to_begin_with() -> None:
    for domain, problem in texts():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HddlWarning)
            read_hddl_text(domain, problem)


@pytest.mark.parametrize("seed", range(8))
def test_damaged_texts(seed: int) -> None:
    random_source = random.Random(seed)
    pairs = texts()
    for domain, problem in islice((random_source.choice(pairs) for _ in range(REPETITIONS)), REPETITIONS):
        if random_source.random() < 0.6:
            attempt(damage(domain, random_source), problem)
        else:
            attempt(domain, damage(problem, random_source))


def test_damaged_bytes(tmp_path: Path) -> None:
    random_source = random.Random(0)
    paths = tmp_path / "domain.hddl", tmp_path / "problem.hddl"
    for _ in range(REPETITIONS):
        for path, text in zip(paths, (DOMAIN, PROBLEM), strict=True):
            data = bytearray(text.encode())
            for _ in range(random_source.choice((0, 1, 1, 3))):
                data[random_source.randrange(len(data))] = random_source.randrange(256)
            path.write_bytes(data)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HddlWarning)
            try:
                read_hddl(*paths)
            except StateHtnError as error:
                assert error.place is not None  # noqa: PT017


def test_swapped_files() -> None:
    attempt(PROBLEM, DOMAIN)
    attempt(DOMAIN, DOMAIN)
    attempt(PROBLEM, PROBLEM)
