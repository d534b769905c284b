"""How many examples tests take whose examples are whole searches: a share of what the profile says."""

from __future__ import annotations

from hypothesis import settings

LEAST = 8


def share_of_examples(divisor: int) -> settings:
    """Return settings for one example where the profile has so many; long runs have as many as they say."""
    examples = settings().max_examples
    return settings(max_examples=examples if examples > 100 else max(LEAST, examples // divisor))
