"""Costs for a domain that is left as it is, from a TOML or JSON file."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

from statehtn.errors import InputError, StateHtnError, UsageError
from statehtn.hddl.diagnostics import unknown
from statehtn.keyed_file import KeyedTable, read_tables
from statehtn.model import Action, And, CostBlock, CostDistribution, CostLaw, Equals, Formula, Not, Problem
from statehtn.model.costs import block_of
from statehtn.model.formula import TRUE

ANY = "*"
OWN_KEYS = ("action", "arguments")


@dataclass(frozen=True, slots=True)
class CostEntry:
    """The law of an action's cost, for all instances or for some.

    Args:
        place: the file and the number of the entry, for messages.
        action: the action's name.
        arguments: an object for each parameter, or `*` for any; None for all instances.
        law: of the cost.
    """

    place: str
    action: str
    arguments: tuple[str, ...] | None
    law: CostLaw

    def covers(self, other: CostEntry) -> bool:
        """Tell whether every instance that the other entry is about is one of this entry's, too."""
        pairs = zip(self.arguments or (), other.arguments or (), strict=False)
        return self.arguments is None or (
            all(mine == ANY for mine in self.arguments)
            or (other.arguments is not None and all(mine in (ANY, its) for mine, its in pairs))
        )

    def overlaps(self, other: CostEntry) -> bool:
        """Tell whether there may be an instance that both entries are about."""
        pairs = zip(self.arguments or (), other.arguments or (), strict=False)
        return all(mine == its or ANY in (mine, its) for mine, its in pairs)

    def condition(self, action: Action) -> Formula:
        """Return the condition on the action's parameters under which this entry is meant."""
        fixed = tuple(
            Equals(parameter.name, name)
            for parameter, name in zip(action.parameters, self.arguments or (), strict=False)
            if name != ANY
        )
        return TRUE if not fixed else fixed[0] if len(fixed) == 1 else And(fixed)


@dataclass(frozen=True, slots=True)
class CostTable:
    """Laws of costs by action and arguments; `read_costs` reads one from a file."""

    entries: tuple[CostEntry, ...]

    def apply(self, problem: Problem) -> Problem:
        """Return a problem in which actions cost what the entries say; the problem that is given stays as it is.

        Of several entries for an instance the first one counts. It replaces the whole cost of the action. Instances and
        actions without an entry keep their cost; that is 1 in a domain that states no cost at all.

        Raises:
            InputError: there is no such action or object, arguments do not fit the parameters, or an entry can never
                count; the message names the entry.
        """
        domain = problem.domain
        by_action: dict[str, list[CostEntry]] = {}
        for entry in self.entries:
            _check(entry, problem, by_action.setdefault(entry.action, []))
            by_action[entry.action].append(entry)
        unit = (block_of(CostDistribution.certain(1)),) if domain.has_unit_costs else None
        actions = {}
        for name, action in domain.actions.items():
            old = action.costs if unit is None else unit
            actions[name] = replace(action, costs=_blocks(action, by_action.get(name, []), old))
        return replace(problem, domain=replace(domain, actions=actions)) if self.entries else problem


def read_costs(file: str | os.PathLike[str]) -> CostTable:
    """Read costs for the actions of a domain from a TOML file, or a JSON file if its name ends in `.json`.

    The file has a list `costs` of tables: `action`, `arguments` where only some instances are meant, and one of
    `cost`, `outcomes`, `samples`, `counts` (with `prior`) and `distribution` (with `parameters`). See docs/costs.md.

    Raises:
        InputError: the file cannot be read, or says something that makes no sense; the message names file, entry and
            key. Names are only checked by `CostTable.apply`.
        UsageError: a `distribution` needs scipy, which is not installed.
    """
    path = Path(file)
    whole = KeyedTable(str(path), read_tables(path))
    whole.check_keys(("costs",))
    tables = whole.values.get("costs")
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        whole.complain("costs", "a list of tables, such as [[costs]] in TOML", tables)
    entries = []
    for number, values in enumerate(tables, 1):
        table = KeyedTable(f"{path}: entry {number} of 'costs'", values)
        entries.append(
            CostEntry(table.place, table.text("action").lower(), _arguments(table), _law(table, path.parent))
        )
    return CostTable(tuple(entries))


def _check(entry: CostEntry, problem: Problem, before: list[CostEntry]) -> None:
    action = problem.domain.actions.get(entry.action)
    if action is None:
        raise InputError(f"{entry.place}: 'action': {unknown('action', entry.action, problem.domain.actions)}")
    if entry.arguments is not None:
        if len(entry.arguments) != len(action.parameters):
            parameters = " ".join(map(str, action.parameters))
            raise InputError(
                f"{entry.place}: 'arguments': expected {len(action.parameters)} for ({entry.action}"
                f"{' ' + parameters if parameters else ''}), found {len(entry.arguments)}"
            )
        for name, parameter in zip(entry.arguments, action.parameters, strict=True):
            if name == ANY:
                continue
            if name not in problem.all_objects:
                raise InputError(f"{entry.place}: 'arguments': {unknown('object', name, problem.all_objects)}")
            if name not in problem.objects_of(parameter.types):
                kind = problem.all_objects[name]
                raise InputError(f"{entry.place}: 'arguments': expected {parameter}, found '{name}', a {kind}")
    for earlier in before:
        if earlier.covers(entry):
            raise InputError(
                f"{entry.place}: it never counts, as {earlier.place.rpartition(': ')[2]} says the cost of the same "
                f"instances before; put what is more special first"
            )


def _blocks(action: Action, entries: list[CostEntry], old: tuple[CostBlock, ...]) -> tuple[CostBlock, ...]:
    """Return the cost of an action: what the entries say, and its old cost for instances without an entry."""
    found = []
    for number, entry in enumerate(entries):
        others = [earlier for earlier in entries[:number] if earlier.overlaps(entry)]
        condition = _joined(entry.condition(action), action, others)
        found.append(replace(block_of(entry.law), condition=condition))
    if any(entry.condition(action) == TRUE for entry in entries):
        return tuple(found)
    return (*found, *(replace(block, condition=_joined(block.condition, action, entries)) for block in old))


def _joined(condition: Formula, action: Action, others: list[CostEntry]) -> Formula:
    """Return a condition where none of the other entries is meant."""
    parts = condition.operands if isinstance(condition, And) else (condition,)
    parts = (*parts, *(Not(other.condition(action)) for other in others))
    return parts[0] if len(parts) == 1 else And(parts)


def _arguments(table: KeyedTable) -> tuple[str, ...] | None:
    given = table.values.get("arguments")
    if given is None:
        return None
    if not isinstance(given, list) or not all(isinstance(name, str) and name for name in given):
        table.complain("arguments", "a list of objects' names, or * for any", given)
    return tuple(name.lower() for name in given)


def _law(table: KeyedTable, folder: Path) -> CostLaw:
    kinds = [kind for kind in LAWS if kind in table.values]
    if len(kinds) != 1:
        raise InputError(
            f"{table.place}: expected one of {', '.join(LAWS)}, found {' and '.join(kinds) if kinds else 'none'}"
        )
    kind = kinds[0]
    make, also = LAWS[kind]
    table.check_keys((*OWN_KEYS, kind, *also))
    try:
        return make(table, folder)
    except UsageError:
        raise
    except StateHtnError as error:
        if error.message.startswith(table.place):
            raise
        raise type(error)(f"{table.place}: '{kind}': {error.message}") from None


def _certain(table: KeyedTable, _: Path) -> CostLaw:
    return CostDistribution.certain(_number(table, "cost", table.values["cost"]))


def _outcomes(table: KeyedTable, _: Path) -> CostLaw:
    return CostDistribution.of(_pairs(table, "outcomes", "probability, cost"))


def _samples(table: KeyedTable, folder: Path) -> CostLaw:
    given = table.values["samples"]
    if isinstance(given, str):
        return CostDistribution.from_samples(_numbers_in(table, folder / given))
    if not isinstance(given, list):
        table.complain("samples", "a list of numbers, or the name of a file with numbers", given)
    return CostDistribution.from_samples([_number(table, "samples", value) for value in given])


def _counts(table: KeyedTable, _: Path) -> CostLaw:
    counts = _by_cost(table, "counts", "count, cost")
    prior = table.values.get("prior", 1)
    weights = _by_cost(table, "prior", "weight, cost") if isinstance(prior, list) else _number(table, "prior", prior)
    return CostDistribution.from_counts(counts, weights)


def _distribution(table: KeyedTable, _: Path) -> CostLaw:
    try:
        import scipy.stats as families
    except ImportError:
        raise UsageError(
            f"{table.place}: 'distribution' needs the package 'scipy': pip install 'statehtn[scipy]'"
        ) from None
    name = table.text("distribution")
    family = getattr(families, name, None)
    if not isinstance(family, families.rv_continuous | families.rv_discrete):
        table.complain("distribution", "the name of a distribution of scipy.stats, such as 'gamma'", name)
    given = table.values.get("parameters", {})
    if not isinstance(given, dict):
        table.complain("parameters", "a table of numbers", given)
    shapes = [shape.strip() for shape in (family.shapes or "").split(",") if shape.strip()]
    known = [*shapes, "loc", *(["scale"] if isinstance(family, families.rv_continuous) else [])]
    for key, value in given.items():
        if key not in known:
            table.complain("parameters", f"some of {', '.join(known)} for '{name}'", key)
        _number(table, "parameters", value)
    missing = [shape for shape in shapes if shape not in given]
    if missing:
        raise InputError(f"{table.place}: 'parameters': '{name}' needs {', '.join(missing)}")
    return CostDistribution.from_scipy(family(**given))


LAWS: Mapping[str, tuple[Callable[[KeyedTable, Path], CostLaw], tuple[str, ...]]] = MappingProxyType(
    {
        "cost": (_certain, ()),
        "outcomes": (_outcomes, ()),
        "samples": (_samples, ()),
        "counts": (_counts, ("prior",)),
        "distribution": (_distribution, ("parameters",)),
    }
)
"""For every key that states a law what reads it, and the keys that go with it."""


def _number(table: KeyedTable, key: str, value: Any) -> float:
    if not isinstance(value, int | float) or isinstance(value, bool):
        table.complain(key, "a number" if key != "parameters" else "numbers", value)
    try:
        return float(value)
    except OverflowError:
        raise InputError(f"{table.place}: '{key}': a number of {len(str(value))} digits is too large") from None


def _pairs(table: KeyedTable, key: str, what: str) -> list[tuple[float, float]]:
    given = table.values[key]
    if not isinstance(given, list) or not given:
        table.complain(key, f"a list of pairs [{what}]", given)
    for pair in given:
        if not isinstance(pair, list) or len(pair) != 2:
            table.complain(key, f"a list of pairs [{what}]", pair)
    number = partial(_number, table, key)
    return [(number(first), number(second)) for first, second in given]


def _by_cost(table: KeyedTable, key: str, what: str) -> dict[float, float]:
    found: dict[float, float] = {}
    for weight, cost in _pairs(table, key, what):
        if cost in found:
            table.complain(key, "each cost once", cost)
        found[cost] = weight
    return found


def _numbers_in(table: KeyedTable, path: Path) -> list[float]:
    """Read numbers that are separated by white space, commas or semicolons."""
    try:
        words = path.read_text(encoding="utf-8").replace(",", " ").replace(";", " ").split()
    except OSError as error:
        raise InputError(f"{table.place}: 'samples': cannot read '{path}': {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{table.place}: 'samples': '{path}' is no text file") from None
    numbers = []
    for word in words:
        try:
            numbers.append(float(word))
        except ValueError:
            raise InputError(f"{table.place}: 'samples': expected numbers in '{path}', found '{word}'") from None
    return numbers
