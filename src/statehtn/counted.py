"""Numbers of things in words."""

from __future__ import annotations


def counted(number: int, noun: str) -> str:
    """Return a number and what it counts, such as `1 step` or `20 steps`; the noun has a regular plural."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
