"""How many examples tests take whose examples are whole searches: a share of what the profile says."""

from __future__ import annotations

from hypothesis import settings

LEAST = 8
MANY = 100
"""Examples: a profile of more is one for long runs."""


def share_of_examples(divisor: int) -> settings:
    """Return settings for one example where the profile has so many; long runs have as many as they say."""
    examples = settings().max_examples
    return settings(max_examples=examples if is_long_run() else max(LEAST, examples // divisor))


def is_long_run() -> bool:
    """Tell whether the profile asks for long runs, in which an example may look at more, too."""
    return settings().max_examples > MANY
