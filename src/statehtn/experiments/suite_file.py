"""Read a suite of one's own from a TOML file: which problems, and what each is run with."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from statehtn.compatible import HEURISTIC_CHOICES, NOTHING, SOLVERS, SWITCHES, switches_in
from statehtn.core.searches import SEARCHES
from statehtn.errors import InputError, UsageError
from statehtn.experiments.instances import is_domain
from statehtn.experiments.run import Grid, Instance, objectives_of
from statehtn.keyed_file import KeyedTable, read_tables
from statehtn.risk import Attitude, Keep
from statehtn.settings import keeps

Part = tuple[Grid, list[Instance]]
"""Problems, and what they are run with."""
AGENT_KEYS = ("attitudes", "alphas", "objectives")
GRID_KEYS = (
    *(*AGENT_KEYS, "keep", "precision"),
    *("solvers", "heuristics", "searches", "without", "repeat", "time-limit", "memory-limit"),
)
"""Keys of the whole file, and of each `[[runs]]`, whose values count there instead."""
RUNS_KEYS = ("domain", "problems", "name", *GRID_KEYS)


def read_suite(file: Path) -> list[Part]:
    """Read a suite from a TOML file (`docs/compare.md` has the keys); paths are relative to the file.

    Raises:
        InputError: the file cannot be read, is no TOML, or says something that makes no sense.
    """
    tables = read_tables(file)
    whole = _Table(str(file), tables)
    whole.check_keys((*GRID_KEYS, "runs"))
    runs = tables.get("runs")
    if not isinstance(runs, list) or not runs or not all(isinstance(table, dict) for table in runs):
        raise InputError(f"{file}: expected at least one table [[runs]] with 'domain' and 'problems'")
    common = {key: value for key, value in tables.items() if key != "runs"}
    return [_part(file, common, table, number) for number, table in enumerate(runs, 1)]


def _part(file: Path, common: Mapping[str, Any], own: Mapping[str, Any], number: int) -> Part:
    """Read a table `[[runs]]`; `common` is what the whole file says."""
    _Table(f"{file}: [[runs]] {number}", own).check_keys(RUNS_KEYS)
    if any(key in own for key in AGENT_KEYS):  # they say together who plans
        common = {key: value for key, value in common.items() if key not in AGENT_KEYS}
    table = _Table(f"{file}: [[runs]] {number}", {**common, **own})
    attitudes = table.names("attitudes", [str(attitude) for attitude in Attitude])
    try:
        objectives = objectives_of(attitudes, table.alphas(), table.objectives())
    except UsageError as error:
        raise InputError(f"{table.place}: {error} ({', '.join(map(repr, AGENT_KEYS))})") from None
    grid = Grid(
        objectives=objectives,
        solvers=table.names("solvers", SOLVERS),
        heuristics=table.names("heuristics", HEURISTIC_CHOICES),
        searches=table.names("searches", SEARCHES),
        without=table.omissions("without"),
        keep=table.keep(),
        precision=table.positive("precision"),
        repeat=table.repeat(),
        time_limit=table.positive("time-limit"),
        memory_limit=table.positive("memory-limit"),
    )
    return grid, _instances(file.parent, table)


def _instances(folder: Path, table: _Table) -> list[Instance]:
    """Return the problems of a table, sorted by name, each once; a domain that a pattern matches is no problem."""
    domain = folder / table.text("domain")
    if not domain.is_file():
        table.complain("domain", "the path of a file, relative to this one", str(table.values["domain"]))
    name = table.text("name", domain.resolve().parent.name)
    problems: dict[Path, None] = {}
    for pattern in table.texts("problems"):
        if (folder / pattern).is_file():
            problems[folder / pattern] = None
            continue
        try:
            found = [path for path in sorted(folder.glob(pattern)) if path.is_file() and not is_domain(path)]
        except (NotImplementedError, ValueError):  # an absolute one, or none that can be
            found = []
        if not found:
            table.complain("problems", "paths or patterns of problems, relative to this file", pattern)
        problems.update(dict.fromkeys(found))
    return [Instance(name, _problem_name(problem, domain), str(domain), str(problem)) for problem in problems]


def _problem_name(problem: Path, domain: Path) -> str:
    """Return the path from the domain's folder, without ending; the file's name alone where it is not below."""
    problem, folder = problem.resolve(), domain.resolve().parent
    name = problem.relative_to(folder) if problem.is_relative_to(folder) else Path(problem.name)
    return name.with_suffix("").as_posix()


class _Table(KeyedTable):
    """A table of a suite."""

    def texts(self, key: str) -> list[str]:
        value = self.values.get(key)
        if value is None:
            raise InputError(f"{self.place}: '{key}' is missing")
        listed = [value] if isinstance(value, str) else value
        if not isinstance(listed, list) or not listed or not all(isinstance(item, str) and item for item in listed):
            self.complain(key, "text, or a list of texts", value)
        return listed

    def names(self, key: str, known: Iterable[str]) -> list[str]:
        names = self.texts(key) if key in self.values else []
        for name in names:
            if name not in known:
                self.complain(key, f"some of {', '.join(known)}", name)
        return list(dict.fromkeys(names))

    def omissions(self, key: str) -> list[tuple[str, ...]]:
        omissions: dict[tuple[str, ...], None] = {}
        for text in self.texts(key) if key in self.values else []:
            try:
                omissions[switches_in(text)] = None
            except UsageError:
                self.complain(key, f"'{NOTHING}' alone, or some of {', '.join(SWITCHES)} joined by +", text)
        return list(omissions)

    def objectives(self) -> list[str]:
        return self.texts("objectives") if "objectives" in self.values else []

    def keep(self) -> tuple[Keep, ...]:
        try:
            return keeps(self.texts("keep") if "keep" in self.values else ())
        except UsageError as error:
            raise InputError(f"{self.place}: {error} ('keep')") from None

    def alphas(self) -> list[float]:
        value = self.values.get("alphas", [])
        listed = value if isinstance(value, list) else [value]
        for alpha in listed:
            if not _is_positive(alpha):
                self.complain("alphas", "positive numbers", alpha)
        return [float(alpha) for alpha in dict.fromkeys(listed)]

    def positive(self, key: str) -> float | None:
        value = self.values.get(key)
        if value is not None and not _is_positive(value):
            self.complain(key, "a positive number", value)
        return None if value is None else float(value)

    def repeat(self) -> int | None:
        value = self.values.get("repeat")
        if value is not None and (not isinstance(value, int) or isinstance(value, bool) or value < 1):
            self.complain("repeat", "a whole number of at least 1", value)
        return value


def _is_positive(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value) and value > 0
