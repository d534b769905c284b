"""Numbers of things in words, letters for them, and long texts in short."""

from __future__ import annotations

MOST_CHARACTERS = 80


def counted(number: int, noun: str) -> str:
    """Return a number and what it counts, such as `1 step` or `20 steps`; the noun has a regular plural."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def brief(text: str) -> str:
    """Return a text, cut where it is long."""
    return text if len(text) <= MOST_CHARACTERS else f"{text[: MOST_CHARACTERS - 3]}..."


def letters(index: int) -> str:
    """Return a name for a thing of a list: A to Z, then AA, AB and so on; the first index is 0."""
    text = ""
    index += 1
    while index:
        index, rest = divmod(index - 1, 26)
        text = chr(ord("A") + rest) + text
    return text
