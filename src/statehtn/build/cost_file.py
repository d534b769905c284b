"""Tables of costs from TOML and JSON files."""

from __future__ import annotations

import codecs
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain
from pathlib import Path
from types import MappingProxyType
from typing import Any

from statehtn.build.cost_table import CostEntry, CostTable, Days
from statehtn.build.joint_samples import read_days
from statehtn.errors import InputError, StateHtnError, UsageError
from statehtn.expected import file_name
from statehtn.keyed_file import KeyedTable, read_tables
from statehtn.limits import Limits
from statehtn.model import CostDistribution, CostLaw
from statehtn.model.cost.scipy_call import scipy_call
from statehtn.model.cost.scipy_law import ScipyCost
from statehtn.read_file import read_pieces

ESTIMATES = 3  # of the PERT law: optimistic, likely, pessimistic
OWN_KEYS = ("action", "arguments")
JOINT = "joint"


@dataclass(frozen=True, slots=True)
class _Place:
    """Where names of further files count from, and the limits of reading them."""

    folder: Path
    limits: Limits
    files: list[str]  # that were read


def read_costs(file: str | os.PathLike[str], limits: Limits = Limits()) -> CostTable:
    """Read costs for the actions of a domain from a TOML file, or a JSON file if its name ends in `.json`.

    The file has a list `costs` of tables: `action`, `arguments` where only some instances are meant, and one of
    `cost`, `outcomes`, `samples`, `counts` (with `prior`) and `distribution` (with `parameters`). A table `joint` has
    `samples`, the name of a CSV file of costs that were observed together (`read_joint_samples`). See docs/costs.md.
    The `limits` hold while it and files of samples are read.

    Raises:
        InputError: the file cannot be read, or says something that makes no sense; the message names file, entry and
            key. Names are only checked by `CostTable.apply`.
        UsageError: a `distribution` needs scipy, which is not installed.
        LimitReached: a limit was reached.
    """
    path = Path(file_name(file, "the costs"))
    whole = KeyedTable(str(path), read_tables(path, limits))
    whole.check_keys(("costs", JOINT))
    tables = whole.values.get("costs", [] if JOINT in whole.values else None)
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        whole.complain("costs", "a list of tables, such as [[costs]] in TOML", tables)
    entries = []
    where = _Place(path.parent, limits, [])
    days = _days(whole, where) if JOINT in whole.values else None
    for number, values in enumerate(tables, 1):
        table = KeyedTable(f"{path}: entry {number} of 'costs'", values)
        entries.append(CostEntry(table.place, table.text("action"), _arguments(table), _law(table, where)))
    return CostTable(tuple(entries), tuple(where.files), days)


def _days(whole: KeyedTable, where: _Place) -> Days:
    values = whole.values[JOINT]
    if not isinstance(values, dict):
        whole.complain(JOINT, "a table such as [joint] in TOML", values)
    table = KeyedTable(f"{whole.place}: '{JOINT}'", values)
    table.check_keys(("samples",))
    file = where.folder / table.text("samples")
    where.files.append(str(file))
    return read_days(file, where.limits)


def _arguments(table: KeyedTable) -> tuple[str, ...] | None:
    given = table.values.get("arguments")
    if given is None:
        return None
    if not isinstance(given, list) or not all(isinstance(name, str) and name for name in given):
        table.complain("arguments", "a list of objects' names, or * for any", given)
    return tuple(given)


def _law(table: KeyedTable, where: _Place) -> CostLaw:
    kinds = [kind for kind in LAWS if kind in table.values]
    if len(kinds) != 1:
        raise InputError(
            f"{table.place}: expected one of {', '.join(LAWS)}, found {' and '.join(kinds) if kinds else 'none'}"
        )
    kind = kinds[0]
    make, also = LAWS[kind]
    table.check_keys((*OWN_KEYS, kind, *also))
    try:
        return make(table, where)
    except UsageError:
        raise
    except StateHtnError as error:
        if error.message.startswith(table.place):
            raise
        raise type(error)(f"{table.place}: '{kind}': {error.message}") from None


def _certain(table: KeyedTable, _: _Place) -> CostLaw:
    return CostDistribution.certain(_number(table, "cost", table.values["cost"]))


def _outcomes(table: KeyedTable, _: _Place) -> CostLaw:
    return CostDistribution.of(_pairs(table, "outcomes", "probability, cost"))


def _samples(table: KeyedTable, where: _Place) -> CostLaw:
    given = table.values["samples"]
    if isinstance(given, str):
        where.files.append(str(where.folder / given))
        return CostDistribution.from_samples(_numbers_in(table, where.folder / given, where.limits))
    if not isinstance(given, list):
        table.complain("samples", "a list of numbers, or the name of a file with numbers", given)
    return CostDistribution.from_samples(_number(table, "samples", value) for value in given)


def _counts(table: KeyedTable, _: _Place) -> CostLaw:
    counts = _by_cost(table, "counts", "count, cost")
    prior = table.values.get("prior", 1)
    weights = _by_cost(table, "prior", "weight, cost") if isinstance(prior, list) else _number(table, "prior", prior)
    return CostDistribution.from_counts(counts, weights)


def _pert(table: KeyedTable, _: _Place) -> CostLaw:
    given = table.values["pert"]
    if not isinstance(given, list) or len(given) != ESTIMATES:
        table.complain("pert", "three estimates [least, likely, most]", given)
    _families(table, "pert")
    law = CostDistribution.pert(*(_number(table, "pert", value) for value in given))
    return replace(law, origin=table.place) if isinstance(law, ScipyCost) else law


def _families(table: KeyedTable, key: str) -> Any:
    try:
        import scipy.stats as families
    except ImportError:
        raise UsageError(f"{table.place}: '{key}' needs the package 'scipy': pip install 'statehtn[scipy]'") from None
    return families


def _distribution(table: KeyedTable, _: _Place) -> CostLaw:
    families = _families(table, "distribution")
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
        for one in value if isinstance(value, list) else [value]:
            _number(table, "parameters", one)
    missing = [shape for shape in shapes if shape not in given]
    if missing:
        raise InputError(f"{table.place}: 'parameters': '{name}' needs {', '.join(missing)}")
    with scipy_call(
        f"'{name}' with {', '.join(f'{key} = {value}' for key, value in given.items()) or 'no parameters'}"
    ):
        frozen = family(**given)
    law = CostDistribution.from_scipy(frozen)
    return replace(law, origin=table.place) if isinstance(law, ScipyCost) else law


LAWS: Mapping[str, tuple[Callable[[KeyedTable, _Place], CostLaw], tuple[str, ...]]] = MappingProxyType(
    {
        "cost": (_certain, ()),
        "outcomes": (_outcomes, ()),
        "samples": (_samples, ()),
        "counts": (_counts, ("prior",)),
        "pert": (_pert, ()),
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


def _numbers_in(table: KeyedTable, path: Path, limits: Limits) -> Iterator[float]:
    """Yield numbers that are separated by white space, commas or semicolons, piece of the file by piece."""
    decode = codecs.getincrementaldecoder("utf-8")().decode
    rest = ""  # of the last piece: the beginning of a word that may go on
    try:
        for piece in chain(read_pieces(path, limits), (b"",)):
            text = rest + decode(piece, not piece).replace(",", " ").replace(";", " ")
            words = text.split()
            rest = words.pop() if piece and words and not text[-1].isspace() else ""
            for word in words:
                yield _read_number(table, path, word)
    except UnicodeDecodeError:
        raise InputError(f"{table.place}: 'samples': '{path}' is no text file") from None
    except InputError as error:
        if error.message.startswith(table.place):
            raise
        raise InputError(f"{table.place}: 'samples': {error.message}") from None


def _read_number(table: KeyedTable, path: Path, word: str) -> float:
    try:
        return float(word)
    except ValueError:
        raise InputError(f"{table.place}: 'samples': expected numbers in '{path}', found '{word:.50}'") from None
