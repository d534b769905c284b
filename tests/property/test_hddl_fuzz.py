"""Damaged files give a result or an error of ours, never a crash or a hang.

Runs for some seconds, twice as many where the environment variable CI is set, always with the same seeds. A
failure names the seed; STATEHTN_FUZZ_SEED=<seed> then tries this one alone.
"""

from __future__ import annotations

import os
import random
import re
import signal
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from itertools import count
from pathlib import Path
from types import FrameType

import pytest

from statehtn.errors import StateHtnError
from statehtn.experiments.instances import find_instances
from statehtn.hddl import HddlWarning, read_hddl, read_hddl_text
from statehtn.limits import Limits

DOMAIN = """(define (domain ferry)
  (:requirements :typing :hierarchy :action-costs :probabilistic-effects)
  (:types car boat - vehicle amphibian - car amphibian - boat place)
  (:constants home - place)
  (:predicates (at ?v - (either car boat) ?p - place) (on ?c - car ?b - boat) (foggy) (wet ?c - car))
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
      (forall (?c - car) (when (on ?c ?b) (and (at ?c ?z) (not (on ?c ?b))
        (probabilistic (chance) (and (wet ?c) (increase (total-cost) 1)) 0.5 (when (foggy) (not (wet ?c))))))))))
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
SECONDS = 10.0 if os.environ.get("CI") else 5.0
LARGEST = 100_000  # bytes of a file
LONGEST = 10.0  # seconds for one pair of damaged files; a hundredth of it is usual
Damage = Callable[[str, random.Random], str]


@cache
def pairs() -> list[tuple[str, str]]:
    """Return the texts to damage: the two above, and one pair of each domain of the repository and the competition."""
    found = [(DOMAIN, PROBLEM)]
    folders = [Path(__file__).parents[2] / "domains"]
    if os.environ.get("STATEHTN_IPC"):
        folders.append(Path(os.environ["STATEHTN_IPC"]))
    for folder in folders:
        known = set()
        for instance in find_instances(folder):
            domain, problem = Path(instance.domain_file), Path(instance.problem_file)
            if instance.domain not in known and max(domain.stat().st_size, problem.stat().st_size) <= LARGEST:
                known.add(instance.domain)
                found.append((domain.read_text(encoding="utf-8"), problem.read_text(encoding="utf-8")))
    return found


def cut(text: str, source: random.Random) -> str:
    return text[: source.randrange(len(text) + 1)]


def cut_out(text: str, source: random.Random) -> str:
    first, second = place(text, source)
    return text[:first] + text[second:]


def doubled(text: str, source: random.Random) -> str:
    first, second = place(text, source)
    return text[:second] + text[first:]


def inserted(text: str, source: random.Random) -> str:
    where = source.randrange(len(text) + 1)
    return text[:where] + source.choice(FRAGMENTS) + text[where:]


def exchanged(text: str, source: random.Random) -> str:
    """Put another word or a fragment in the place of a word."""
    words = text.split(" ")
    words[source.randrange(len(words))] = source.choice((*FRAGMENTS, source.choice(words)))
    return " ".join(words)


def shuffled(text: str, source: random.Random) -> str:
    """Put all words, all lines, or two words in another order."""
    separator = source.choice((" ", "\n"))
    parts = text.split(separator)
    if source.random() < 0.2:
        source.shuffle(parts)
    else:
        one, other = source.randrange(len(parts)), source.randrange(len(parts))
        parts[one], parts[other] = parts[other], parts[one]
    return separator.join(parts)


def regrouped(text: str, source: random.Random) -> str:
    """Double, move, drop or wrap what stands in parentheses, so that they stay balanced."""
    first, second = group(text, source)
    other = slice(*group(text, source))
    inside = text[first:second]
    new = source.choice(("", inside * 2, text[other], *(f"({word} {inside})" for word in WRAPPERS)))
    return text[:first] + new + text[second:]


def place(text: str, source: random.Random) -> tuple[int, int]:
    first = source.randrange(len(text) + 1)
    return first, min(len(text), first + source.choice((1, 3, 20, 200, len(text))))


def group(text: str, source: random.Random) -> tuple[int, int]:
    """Return where some parentheses open and close; nothing where there are none."""
    first = text.find("(", source.randrange(len(text) + 1))
    depth = 0
    for match in re.compile(r"[()]").finditer(text, max(first, 0)):
        depth += 1 if match[0] == "(" else -1
        if depth <= 0:
            return (first, match.end()) if first >= 0 else (0, 0)
    return 0, 0


WRAPPERS = ("and", "or", "not", "forall (?z)", "exists (?z)", "when ()", "probabilistic 0.5", "either", "=", "")
DAMAGES: tuple[Damage, ...] = (cut, cut_out, doubled, inserted, exchanged, shuffled, regrouped, regrouped, regrouped)


def damaged(text: str, source: random.Random) -> str:
    for _ in range(source.choice((1, 1, 1, 2, 5))):
        text = source.choice(DAMAGES)(text, source)
    return text[: 2 * LARGEST]


def wrong_bytes(text: str, source: random.Random) -> bytes:
    """Return the text with some bytes changed, or in another encoding."""
    if source.random() < 0.1:
        return text.encode(source.choice(("utf-16", "utf-32", "cp037", "utf-8-sig")), errors="replace")
    data = bytearray(text.encode(errors="surrogatepass"))
    for _ in range(source.choice((1, 1, 3, 100)) if data else 0):
        data[source.randrange(len(data))] = source.randrange(256)
    return bytes(data)


def attempt(seed: int, folder: Path) -> None:
    """Damage a pair of files and read them."""
    source = random.Random(seed)
    domain, problem = source.choice(pairs())
    if source.random() < 0.02:  # of different domains
        problem = source.choice(pairs())[1]
    which = source.random()
    if which < 0.6:
        domain = damaged(domain, source)
    if which > 0.5:
        problem = damaged(problem, source)
    limits = Limits.starting_now(time_limit=LONGEST)  # `LimitReached` is no error of the input: it fails the test
    strict = source.random() < 0.1
    if source.random() < 0.8:
        read_or_refuse(lambda: read_hddl_text(domain, problem, strict=strict, limits=limits))
        return
    paths = folder / "domain.hddl", folder / "problem.hddl"
    for path, text in zip(paths, (domain, problem), strict=True):
        path.write_bytes(wrong_bytes(text, source))
    read_or_refuse(lambda: read_hddl(*paths, strict=strict, limits=limits))


def read_or_refuse(read: Callable[[], object]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HddlWarning)
        try:
            read()
        except StateHtnError as error:
            assert error.place is not None  # noqa: PT017
            assert "\n" not in error.message  # noqa: PT017
            assert len(error.message) < 1100  # noqa: PT017


@contextmanager
def alarm(seconds: float) -> Iterator[None]:
    """Interrupt what hangs without looking at its limits, where the system can."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def ring(_signal: int, _frame: FrameType | None) -> None:
        raise TimeoutError(f"not done after {seconds:g} s")

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def test_the_texts_are_fine_to_begin_with() -> None:
    for domain, problem in pairs():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HddlWarning)
            read_hddl_text(domain, problem)


def test_damaged_files(tmp_path: Path) -> None:
    only = os.environ.get("STATEHTN_FUZZ_SEED")
    end = time.monotonic() + SECONDS
    for seed in [int(only)] if only else count():
        if time.monotonic() > end:
            break
        try:
            with alarm(2 * LONGEST):
                attempt(seed, tmp_path)
        except Exception as error:
            raise AssertionError(f"seed {seed}: {type(error).__name__}: {error}") from error


def test_swapped_files() -> None:
    for domain, problem in ((PROBLEM, DOMAIN), (DOMAIN, DOMAIN), (PROBLEM, PROBLEM)):
        with pytest.raises(StateHtnError):
            read_hddl_text(domain, problem)
