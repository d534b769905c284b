"""What `statehtn why` says of the unsolvable problems of a collection, and whether it is true.

    python -m tests.benchmarks.reasons FOLDER ... [--seconds 10] [--skip SOLVED.csv]

Problems that `statehtn plan` proves to have no plan within the time are asked about. Where things are missing, each set
of them is added to the problem: the relaxation must have a plan then, and none with one of them left out; and whether
the problem has one itself is told. Where nothing goes on, the points are gone to step by step on the lifted model.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import statehtn
from statehtn.experiments.instances import find_instances
from statehtn.experiments.run import Instance
from statehtn.explanation.additions import with_additions
from statehtn.explanation.explanation import relaxed_reason
from statehtn.explanation.reason import Addition
from statehtn.limits import LimitReached, Limits
from statehtn.model import Problem, Step
from statehtn.model.status import Status
from statehtn.semantics.outcomes import Transitions
from statehtn.semantics.world import World

MEGABYTES = 1500


def main() -> None:
    """Ask about all problems of some folders, and print a line for each that has no plan."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--skip", type=Path, help="a table with columns domain, problem and status; leave out 'solved'")
    options = parser.parse_args()
    solved = _solved(options.skip)
    asked = 0
    for folder in options.folders:
        for instance in find_instances(folder):
            if (Path(instance.domain).name, Path(instance.problem).name) in solved:
                continue
            asked += 1
            for line in _lines(instance, options.seconds):
                print(f"{folder.name}/{instance.domain}/{instance.problem}: {line}", flush=True)
    print(f"{asked} problems were looked at", file=sys.stderr)


def _solved(table: Path | None) -> set[tuple[str, str]]:
    if table is None:
        return set()
    with table.open(encoding="utf-8", newline="") as file:
        return {(row["domain"], row["problem"]) for row in csv.DictReader(file) if row["status"] == "solved"}


def _lines(instance: Instance, seconds: float) -> Iterator[str]:
    """Yield what is found out about a problem; nothing unless it is proven within the time that it has no plan."""
    try:
        problem = statehtn.read_hddl(instance.domain_file, instance.problem_file)
        if statehtn.plan(problem, search="greedy", time_limit=seconds, memory_limit=MEGABYTES).status in (
            Status.UNSOLVABLE,
            Status.GAVE_UP,
        ):
            yield from _reasons(problem, seconds)
    except (statehtn.StateHtnError, LimitReached) as error:
        yield f"error: {error}"


def _reasons(problem: Problem, seconds: float) -> Iterator[str]:
    answer = statehtn.why(problem, time_limit=3 * seconds, memory_limit=MEGABYTES)
    assert isinstance(answer, statehtn.NoPlan)
    if answer.status is not Status.UNSOLVABLE:
        yield f"{answer.status}"
    if answer.reason is not None:
        yield f"{answer.reason}; at the root: {next(answer.reason.roots(), answer.reason)}"
    for additions in answer.additions:
        yield _tried(problem, additions, seconds)
    if answer.exploration is not None:
        for deadlock in answer.exploration.deadlocks:
            yield f"after {len(deadlock.steps)} actions, {deadlock.task}: {_replayed(problem, deadlock.steps)}"


def _tried(problem: Problem, additions: Sequence[Addition], seconds: float) -> str:
    """Return whether additions help, all of them and no fewer, and whether they help the problem itself."""
    limits = Limits.starting_now(seconds)
    whole = frozenset(additions)
    helps = relaxed_reason(with_additions(problem, whole), limits) is None
    is_least = all(relaxed_reason(with_additions(problem, whole - {each}), limits) is not None for each in whole)
    verdict = "true" if helps and is_least else "WRONG"
    found = statehtn.plan(with_additions(problem, whole), search="greedy", time_limit=seconds, memory_limit=MEGABYTES)
    return f"{verdict}: with {' and '.join(map(str, additions))}; with that the problem is {found.status}"


def _replayed(problem: Problem, steps: Sequence[Step]) -> str:
    """Return whether steps can be executed one after the other."""
    transitions = Transitions(World(problem))
    facts = problem.initial_state
    for number, step in enumerate(steps, 1):
        outcomes = transitions.outcomes(step, facts)
        if outcomes is None:
            return f"WRONG, step {number} {step} cannot be executed"
        facts = outcomes[0].after(facts)
    return "true, one can come there"


if __name__ == "__main__":
    main()
