"""Numbers of things in words, letters for them, probabilities, numbers for JSON, and long texts in short."""

from __future__ import annotations

import math
from fractions import Fraction

MOST_CHARACTERS = 80


def counted(number: int, noun: str) -> str:
    """Return a number and what it counts, such as `1 step` or `20 steps`; the noun has a regular plural."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def with_article(noun: str) -> str:
    """Return a noun with its article, such as `an action`."""
    return f"{'an' if noun[:1].lower() in set('aeiou') else 'a'} {noun}"


def brief(text: str) -> str:
    """Return a text, cut where it is long."""
    return text if len(text) <= MOST_CHARACTERS else f"{text[: MOST_CHARACTERS - 3]}..."


def likely(probability: Fraction | float, rest: float | None = None, digits: int = 10) -> str:
    """Return a probability as people write it: never 1 where it is not 1, but `1 - 2e-12`.

    Args:
        probability: from 0 to 1.
        rest: the probability of everything else, where it is known better than as the difference to 1.
        digits: that are shown.
    """
    text = f"{float(probability):.{digits}g}"
    other = float(1 - probability if rest is None else rest)
    return f"1 - {other:.3g}" if text == "1" and other > 0 else text


def finite(number: float | None) -> float | None:
    """Return a number as JSON can say it: None, which is null there, for what is infinite or none."""
    return number if number is not None and math.isfinite(number) else None


def letters(index: int) -> str:
    """Return a name for a thing of a list: A to Z, then AA, AB and so on; the first index is 0."""
    text = ""
    index += 1
    while index:
        index, rest = divmod(index - 1, 26)
        text = chr(ord("A") + rest) + text
    return text
