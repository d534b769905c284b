"""Tables as text and as HTML that needs no style sheet."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

CELL = "padding: 0.1em 0.8em; border: 0"
MOST_ROWS = 1000  # of a table in HTML
WHOLE = re.compile(r"[^.e]*")
"""What stands before the point of a number, or before its exponent."""
RULE = "border-top: 1px solid rgba(128, 128, 128, 0.6)"


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table: its head, and whether it holds numbers, which stand to the right."""

    head: str
    is_number: bool = False


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of text under heads; a last row of totals and a title where there are any."""

    columns: Sequence[Column]
    rows: Sequence[Sequence[str]]
    totals: Sequence[str] = ()
    title: str = ""

    def aligned(self, between: str) -> tuple[list[str], int]:
        """Return the heads, the rows and the totals with each cell padded to its column, and how wide they are.

        It takes microseconds for a row, where rich takes a millisecond: a plan may have 65 000.

        Args:
            between: stands between columns.
        """
        lines = [[column.head for column in self.columns], *self.rows, *([self.totals] if self.totals else [])]
        cells = zip(*lines, strict=True)
        padded = [_padded(texts, column.is_number) for texts, column in zip(cells, self.columns, strict=True)]
        shown = [between.join(row) for row in zip(*padded, strict=True)]
        return [line.rstrip() for line in shown], _width(shown[0])

    def to_text(self) -> str:
        """Return the table in columns of characters, with two spaces between them."""
        shown, width = self.aligned("  ")
        rule = "─" * width
        shown.insert(1, rule)
        if self.totals:
            shown.insert(-1, rule)
        return "\n".join(shown)

    def to_html(self) -> str:
        """Return a `<table>` with its own styles, readable on light and on dark ground; all text is escaped."""
        head = "".join(self._cell("th", column.head, column) for column in self.columns)
        body = "".join(f"<tr>{self._row(row)}</tr>" for row in self._shown_rows())
        foot = f"<tr>{self._row(self.totals, f'; {RULE}; font-weight: bold')}</tr>" if self.totals else ""
        return (
            f'<table style="border-collapse: collapse; margin: 0.4em 0; color: inherit"><thead><tr>{head}</tr></thead>'
            f"<tbody>{body}{foot}</tbody></table>"
        )

    def _shown_rows(self) -> Sequence[Sequence[str]]:
        """Return the rows; of very many the first and the last ones, since browsers take long over them."""
        if len(self.rows) <= MOST_ROWS:
            return self.rows
        half = MOST_ROWS // 2
        gap = ["", f"... {len(self.rows) - 2 * half} more ...", *[""] * len(self.columns)][: len(self.columns)]
        return [*self.rows[:half], gap, *self.rows[-half:]]

    def _row(self, row: Sequence[str], style: str = "") -> str:
        return "".join(self._cell("td", cell, column, style) for cell, column in zip(row, self.columns, strict=True))

    def _cell(self, tag: str, text: str, column: Column, style: str = "") -> str:
        align = "right" if column.is_number else "left"
        return f'<{tag} style="{CELL}; text-align: {align}{style}">{escape(text)}</{tag}>'


def on_the_point(numbers: Sequence[str]) -> list[str]:
    """Return numbers with spaces around them, so that their decimal points stand below each other."""
    wholes = [len(WHOLE.match(number)[0]) for number in numbers]  # type: ignore[index]
    most = max(wholes, default=0)
    return _padded([f"{' ' * (most - whole)}{number}" for number, whole in zip(numbers, wholes, strict=True)], False)


def _width(text: str) -> int:
    """Return how many characters wide a text is; some of Asian scripts are two wide."""
    if text.isascii():
        return len(text)
    from rich.cells import cell_len

    return cell_len(text)


def _padded(texts: Sequence[str], is_right: bool) -> list[str]:
    """Return texts with spaces before or after them, as wide as the widest."""
    widths = list(map(_width, texts))
    widest = max(widths)
    spaces = [" " * (widest - width) for width in widths]
    parts = (spaces, texts) if is_right else (texts, spaces)
    return list(map("".join, zip(*parts, strict=True)))
