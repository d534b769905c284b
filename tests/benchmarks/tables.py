"""Rows of measurements as CSV files, and tables of them."""

from __future__ import annotations

import argparse
import csv
import math
import os
import platform
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any, ClassVar, Protocol, TypeVar


class _Named(Protocol):
    """A row: a dataclass with a name that no other row has."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    @property
    def name(self) -> str: ...


Row = TypeVar("Row", bound=_Named)


def read_rows(kind: type[Row], path: Path) -> list[Row]:
    """Return the rows of an earlier output: a dataclass of texts and of numbers that may be missing."""
    with open(path, newline="", encoding="utf-8") as file:
        return [
            kind(**{name: _value(line[name], kind_of) for name, kind_of in _columns(kind)})
            for line in csv.DictReader(file)
        ]


def measure_all(
    kind: type[Row],
    cases: Mapping[str, Callable[[], Row]],
    options: argparse.Namespace,
    line: Callable[[Row], str],
) -> list[Row]:
    """Measure all cases, some at once; write the row of each and print a line about it as it ends.

    Args:
        kind: of the rows; they have the cases' names.
        cases: what makes each row.
        options: those of `add_measuring`.
        line: what is printed about a row.
    """
    has_output = options.output is not None and options.output.exists()
    rows = read_rows(kind, options.output) if options.resume and has_output else []
    known = {row.name for row in rows}
    with (
        open(options.output or os.devnull, "w", newline="", encoding="utf-8") as file,
        ThreadPoolExecutor(options.jobs) as pool,
    ):
        writer = csv.DictWriter(file, [name for name, _ in _columns(kind)])
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)
        todo = [case for name, case in cases.items() if name not in known]
        for row in pool.map(lambda case: case(), todo):
            rows.append(row)
            writer.writerow(asdict(row))
            file.flush()
            print(line(row), flush=True)
    return rows


def add_measuring(parser: argparse.ArgumentParser) -> None:
    """Add the options of `measure_all`."""
    parser.add_argument("--output", type=Path, help="write a line of CSV for each problem as soon as it is done")
    parser.add_argument("--resume", action="store_true", help="keep what the output has already")
    parser.add_argument("--jobs", type=int, default=1, help="measure so many at once")


def _columns(kind: type) -> list[tuple[str, str]]:
    return [(field.name, str(field.type)) for field in fields(kind)]


def _value(text: str, kind: str) -> object:
    if "str" in kind:
        return text
    if not text:
        return None
    return float(text) if "float" in kind else int(text)


def table(header: Sequence[str], lines: Iterable[Sequence[str]]) -> Iterator[str]:
    """Yield a Markdown table whose columns are aligned in plain text, too; all but the first to the right."""
    rows = [header, *lines]
    widths = [max(len(row[column]) for row in rows) for column in range(len(header))]
    for at, row in enumerate(rows):
        cells = [row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True))]
        yield f"| {' | '.join(cells)} |"
        if at == 0:
            yield f"|{'-' * (widths[0] + 2)}|{'|'.join('-' * (width + 1) + ':' for width in widths[1:])}|"


def figure(value: float | None, form: str) -> str:
    """Format a number that may be missing."""
    return "" if value is None else format(value, form)


def section(title: str, lines: Iterable[str], markdown: bool) -> Iterator[str]:
    """Yield a heading with the number of lines, and the lines."""
    found = list(lines)
    yield ""
    yield f"{'### ' if markdown else ''}{title}: {len(found)}"
    if markdown and found:
        yield ""
    yield from (f"{'- ' if markdown else '  '}{line.strip()}" for line in found)


def geometric_mean(values: Iterable[float]) -> float:
    logarithms = [math.log(value) for value in values]
    return math.exp(sum(logarithms) / len(logarithms))


def machine() -> str:
    """Describe the machine in one line."""
    name = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            name = next((line.split(":")[1].strip() for line in file if line.startswith("model name")), name)
    except OSError:
        pass
    return f"{name}, {os.cpu_count()} cores, {platform.system()}, Python {platform.python_version()}"
