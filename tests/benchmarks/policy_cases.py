"""Flat problems of verification, wrapped as an HTN: one task, done where the goal holds, or any action and again.

`consensus`: the shared coin of Aspnes and Herlihy (*Fast randomized consensus using shared memory*, 1990), as model
checkers know it: processes toss coins and move a counter until it is far from the middle. `grid`: a robot collects keys
on slippery ground. The texts are our own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class FlatCase:
    """A problem as HDDL text, and how many states can be reached in it."""

    name: str
    domain: str
    problem: str
    states: int


def wrapped(actions: Sequence[tuple[str, str]], goal: str, predicates: str, types: str, text: str) -> str:
    """The domain of actions (name, typed parameters), given as text, with the task that does any of them."""
    methods = [
        f"  (:method then-{name} :parameters ({parameters}) :task (solve) :ordered-subtasks "
        f"(and ({name} {' '.join(word for word in parameters.split() if word.startswith('?'))}) (solve)))"
        for name, parameters in actions
    ]
    return "\n".join(
        [
            "(define (domain flat)",
            f"  (:types {types})",
            f"  (:predicates {predicates})",
            "  (:functions (total-cost) - number)",
            "  (:task solve :parameters ())",
            f"  (:method done :parameters () :task (solve) :precondition {goal} :ordered-subtasks ())",
            *methods,
            text,
            ")",
        ]
    )


def problem_text(objects: str, facts: str) -> str:
    network = "(:htn :parameters () :ordered-subtasks (and (solve)))"
    return (
        f"(define (problem p) (:domain flat) (:objects {objects}) {network}\n"
        f"  (:init {facts})\n  (:metric minimize (total-cost)))"
    )


COIN = """
  (:action flip :parameters (?p - process)
    :precondition (flipping ?p)
    :effect (and (not (flipping ?p)) (writing ?p) (increase (total-cost) 1)
      (probabilistic 0.5 (heads ?p) 0.5 ())))
  (:action write-heads :parameters (?p - process ?c ?d - level)
    :precondition (and (writing ?p) (heads ?p) (counter ?c) (above ?d ?c))
    :effect (and (not (writing ?p)) (not (heads ?p)) (checking ?p) (not (counter ?c)) (counter ?d)
      (increase (total-cost) 1)))
  (:action write-tails :parameters (?p - process ?c ?d - level)
    :precondition (and (writing ?p) (not (heads ?p)) (counter ?c) (above ?c ?d))
    :effect (and (not (writing ?p)) (checking ?p) (not (counter ?c)) (counter ?d) (increase (total-cost) 1)))
  (:action decide-tails :parameters (?p - process ?c - level)
    :precondition (and (checking ?p) (counter ?c) (low ?c))
    :effect (and (not (checking ?p)) (finished ?p) (increase (total-cost) 1)))
  (:action decide-heads :parameters (?p - process ?c - level)
    :precondition (and (checking ?p) (counter ?c) (high ?c))
    :effect (and (not (checking ?p)) (finished ?p) (heads ?p) (increase (total-cost) 1)))
  (:action go-on :parameters (?p - process ?c - level)
    :precondition (and (checking ?p) (counter ?c) (middle ?c))
    :effect (and (not (checking ?p)) (flipping ?p) (increase (total-cost) 1)))"""


def consensus(processes: int, bound: int) -> FlatCase:
    """So many processes whose counter goes from 0 to `2 (bound + 1) processes`."""
    top = 2 * (bound + 1) * processes
    actions = [
        ("flip", "?p - process"),
        ("write-heads", "?p - process ?c ?d - level"),
        ("write-tails", "?p - process ?c ?d - level"),
        *((name, "?p - process ?c - level") for name in ("decide-tails", "decide-heads", "go-on")),
    ]
    own = " ".join(f"({name} ?p - process)" for name in ("flipping", "writing", "checking", "finished", "heads"))
    predicates = (
        f"{own} (counter ?c - level) (above ?d ?c - level) (low ?c - level) (high ?c - level) (middle ?c - level)"
    )
    domain = wrapped(actions, "(forall (?p - process) (finished ?p))", predicates, "process level", COIN)
    levels = range(top + 1)
    facts = [f"(flipping p{number})" for number in range(processes)]
    facts += [f"(above c{level + 1} c{level})" for level in levels[:-1]]
    for level in levels:
        place = "low" if level <= processes else "high" if level >= top - processes else "middle"
        facts.append(f"({place} c{level})")
    facts.append(f"(counter c{top // 2})")
    objects = f"{' '.join(f'p{number}' for number in range(processes))} - process "
    objects += f"{' '.join(f'c{level}' for level in levels)} - level"
    # Known of this model: 22 656 states for four processes and bound 2, and 10 240 more for each further one.
    states = {2: 272 + 128 * (bound - 2), 4: 22_656 + 10_240 * (bound - 2)}[processes]
    return FlatCase(f"consensus {processes} {bound}", domain, problem_text(objects, " ".join(facts)), states)


GROUND = """
  (:action move :parameters (?from ?to ?left ?right - cell)
    :precondition (and (at ?from) (way ?from ?to ?left ?right))
    :effect (and (not (at ?from)) (increase (total-cost) 1)
      (probabilistic 0.8 (at ?to) 0.1 (at ?left) 0.1 (at ?right))))
  (:action collect :parameters (?k - key ?c - cell)
    :precondition (and (at ?c) (lies ?k ?c))
    :effect (and (not (lies ?k ?c)) (collected ?k) (increase (total-cost) 1)))"""


def grid(width: int, keys: int) -> FlatCase:
    """A square of cells with keys in it; the robot slips to the side of where it wants to go."""

    def cell(x: int, y: int) -> str:
        return f"c{min(max(x, 0), width - 1)}-{min(max(y, 0), width - 1)}"

    ways = set()
    for x in range(width):
        for y in range(width):
            for dx, dy in ((1, 0), (0, 1), (-1, 0), (0, -1)):
                if cell(x + dx, y + dy) != cell(x, y):
                    aside = cell(x + dy, y + dx), cell(x - dy, y - dx)
                    ways.add(f"(way {cell(x, y)} {cell(x + dx, y + dy)} {' '.join(aside)})")
    places = [cell(number * width // keys, width - 1 - number * (width - 1) // (keys + 1)) for number in range(keys)]
    facts = [*sorted(ways), "(at c0-0)", *(f"(lies k{number} {place})" for number, place in enumerate(places))]
    objects = " ".join(sorted({cell(x, y) for x in range(width) for y in range(width)})) + " - cell "
    objects += " ".join(f"k{number}" for number in range(keys)) + " - key"
    predicates = "(at ?c - cell) (way ?a ?b ?l ?r - cell) (lies ?k - key ?c - cell) (collected ?k - key)"
    actions = [("move", "?from ?to ?left ?right - cell"), ("collect", "?k - key ?c - cell")]
    domain = wrapped(actions, "(forall (?k - key) (collected ?k))", predicates, "cell key", GROUND)
    return FlatCase(f"grid {width} {keys}", domain, problem_text(objects, " ".join(facts)), width * width * 2**keys)


CASES: dict[str, Callable[[], FlatCase]] = {
    "small consensus": lambda: consensus(2, 2),
    "consensus": lambda: consensus(4, 8),
    "large consensus": lambda: consensus(4, 48),
    "small grid": lambda: grid(10, 2),
    "grid": lambda: grid(50, 5),
    "large grid": lambda: grid(90, 6),
}
"""The sizes that are measured: some 80 000 states, and some 500 000; and small ones to try it."""
