"""Readable output: fits a terminal, and stays readable in a pipe and without colours."""

from __future__ import annotations

import io
import os
import shutil
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TextIO

from statehtn.display.table import Table

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.table import Table as RichTable

PIPE_WIDTH = 100_000  # in a pipe nothing is wrapped
MOST_WRAPPED = 1000  # rows; longer tables are not wrapped where a terminal is too narrow for them


@dataclass(frozen=True, slots=True)
class Summary:
    """Labels, what each says, and the style of what the first one says."""

    rows: Sequence[tuple[str, str]]
    style: str = ""


def rendered(
    parts: Iterable[Table | Summary], *, stream: TextIO | None = None, wrap: bool = True, between: str = "   "
) -> str:
    """Render for a stream: coloured and, unless told not to, wrapped on a terminal; plain and wide elsewhere.

    The environment has its say: NO_COLOR leaves out colours, FORCE_COLOR asks for them elsewhere, too, and a terminal
    with TERM=dumb has none.

    Args:
        parts: stand below each other.
        stream: standard output if none is given.
        wrap: to the width of a terminal.
        between: stands between the columns of tables.
    """
    from rich.console import Console  # takes a moment to import

    terminal = (stream or sys.stdout).isatty()
    styled = terminal or os.environ.get("FORCE_COLOR", "") != ""
    console = Console(
        file=io.StringIO(),
        force_terminal=styled,
        color_system="auto" if styled else None,
        width=shutil.get_terminal_size().columns if terminal and wrap else PIPE_WIDTH,
        markup=False,
        highlight=False,
        emoji=False,
    )
    texts = (_summary(part, console) if isinstance(part, Summary) else _table(part, console, between) for part in parts)
    return "\n".join(texts).strip("\n")


def _table(table: Table, console: Console, between: str) -> str:
    """Return a table as rich lays it out; it does so itself only where lines must be wrapped, as it takes long."""
    (head, *body), width = table.aligned(between)
    if width + 1 > console.width and len(table.rows) <= MOST_WRAPPED:
        return _printed(_wrapped(table), console)
    from rich.text import Text

    heads = "\n".join([*([table.title, ""] if table.title else []), f" {head}"])
    lines = [f" {'─' * width}", *(f" {line}".rstrip() for line in body)]
    if table.totals:
        lines.insert(-1, "")
    return "\n".join([_printed(Text(heads, "bold"), console, soft_wrap=True), *lines, ""])


def _wrapped(table: Table) -> RichTable:
    from rich import box
    from rich.table import Table as RichTable

    wrapped = RichTable(
        box=box.SIMPLE_HEAD,
        pad_edge=False,
        title=table.title or None,
        title_justify="left",
        title_style="bold",
        header_style="bold",
    )
    for column in table.columns:
        wrapped.add_column(column.head, justify="right" if column.is_number else "left")
    for row in table.rows:
        wrapped.add_row(*row)
    if table.totals:
        wrapped.add_section()
        wrapped.add_row(*table.totals)
    return wrapped


def _summary(summary: Summary, console: Console) -> str:
    from rich.table import Table as RichTable
    from rich.text import Text

    grid = RichTable.grid("", "", padding=(0, 2, 0, 0))
    for index, (label, value) in enumerate(summary.rows):
        grid.add_row(Text(label, "dim"), Text(value, "" if index else summary.style))
    return _printed(grid, console)


def _printed(shown: RenderableType, console: Console, soft_wrap: bool = False) -> str:
    with console.capture() as capture:
        console.print(shown, soft_wrap=soft_wrap)
    return "\n".join(line.rstrip() for line in capture.get().splitlines())
