"""Write a suite for `statehtn compare`: the problems of another planner's table, or an ablation.

Usage: python -m tests.benchmarks.suite --root DIR (--baseline FILE.csv | --ablation FILE.csv) > SUITE.toml

The folder of the benchmarks is that of --root or of the environment variable STATEHTN_IPC. --baseline: the problems
of that table, whose columns `tests.benchmarks.search` tells, each with the limit that the baseline had for its search
and 60 s more for reading and grounding. --ablation: of a comparison's table, the problems that the complete
configuration, `state auto`, has solved after 5 ms to 5 s of search; shorter ones tell nothing, longer ones take too
long. Each is run by the complete configuration again, by it without each refinement in turn, and by each admissible
heuristic alone, within a second and 20 times as long as the complete configuration took for everything.
"""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from statehtn.compatible import NOTHING, PRICE_SWITCHES
from statehtn.core.heuristics import ADMISSIBLE
from statehtn.experiments.instances import find_instances
from statehtn.experiments.run import Instance
from tests.benchmarks.records import COMPLETE, Row, read_runs
from tests.benchmarks.search import Line, name_of, read_baseline

MEMORY_MB = 8000
PREPARATION_SECONDS = 60.0
LEAST_SECONDS = 0.005
MOST_SECONDS = 5.0
TIMES_AS_LONG = 20

Instances = dict[str, Instance]
"""Problems by the names that rows have."""


def search_suite(instances: Instances, lines: Iterable[Line]) -> Iterator[str]:
    """Yield the lines of a suite of the problems of a baseline."""
    yield f"memory-limit = {MEMORY_MB}"
    for line in lines:
        yield from _runs(instances[name_of(line)], PREPARATION_SECONDS + float(line["engine_limit"]))


def ablation_suite(instances: Instances, rows: Iterable[Row]) -> Iterator[str]:
    """Yield the lines of a suite that runs every variant on the problems that are worth it, one after the other."""
    yield f"memory-limit = {MEMORY_MB}"
    for row in rows:
        is_search = row.configuration == COMPLETE and row.solved
        if is_search and LEAST_SECONDS <= (row.search_seconds or 0.0) <= MOST_SECONDS:
            limit = round(1 + TIMES_AS_LONG * row.seconds, 3)
            yield from _runs(instances[row.name], limit, without=[NOTHING, *PRICE_SWITCHES])
            yield from _runs(instances[row.name], limit, heuristics=list(ADMISSIBLE))


def _runs(instance: Instance, time_limit: float, **more: list[str]) -> Iterator[str]:
    files = (str(Path(name).resolve()) for name in (instance.domain_file, instance.problem_file))
    keys = dict(zip(("domain", "problems"), files, strict=True))
    yield "\n[[runs]]"
    for key, value in ({"name": instance.domain, **keys, "time-limit": time_limit} | more).items():
        yield f"{key} = {json.dumps(value)}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=Path, default=os.environ.get("STATEHTN_IPC") or None)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--baseline", type=Path)
    what.add_argument("--ablation", type=Path)
    options = parser.parse_args()
    if options.root is None:
        parser.error("name the folder of the benchmarks by --root or STATEHTN_IPC")
    instances = {f"{one.domain} {one.problem}": one for one in find_instances(options.root)}
    if options.baseline:
        lines = search_suite(instances, read_baseline(options.baseline))
    else:
        lines = ablation_suite(instances, read_runs(options.ablation))
    print("\n".join(lines))


if __name__ == "__main__":
    main()
