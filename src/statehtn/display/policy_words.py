"""What is said of a policy: how outcomes and amounts are told from others, and what an action costs."""

from __future__ import annotations

import math
from collections.abc import Sequence

from statehtn.display.words import changes_text, number
from statehtn.model.policy_graph import Branch
from statehtn.model.problem import Fact

Changes = tuple[frozenset[Fact], frozenset[Fact]]
"""The facts that an outcome makes true, and those that it makes false."""
OTHERWISE = "otherwise"
"""The condition of an outcome of which nothing that matters tells it from the others."""


def conditions(outcomes: Sequence[Changes]) -> dict[Changes, str]:
    """Return how each outcome is told from the others: by facts that not all of them change alike."""
    if len(outcomes) <= 1:
        return dict.fromkeys(outcomes, "")
    all_added = frozenset.intersection(*(added for added, _ in outcomes))
    all_deleted = frozenset.intersection(*(deleted for _, deleted in outcomes))
    texts: dict[Changes, str] = {}
    for added, deleted in outcomes:
        texts[added, deleted] = changes_text(added - all_added, deleted - all_deleted) or OTHERWISE
    return texts


def cost_text(branches: Sequence[Branch]) -> str:
    """Return what an action costs, in words: its law where there is one, else from the least to the largest."""
    laws = {str(branch.law) for branch in branches}
    if len(laws) <= 1:
        return next(iter(laws), "")
    least, most = min(branch.law.least for branch in branches), max(branch.law.most for branch in branches)
    if math.isinf(most):
        return f"at least {number(least)}"
    return number(least) if least == most else f"{number(least)} to {number(most)}"


def budget(rank: int, limits: Sequence[float]) -> str:
    """Return which amounts a group is for: those of the groups before it are at most their limits."""
    low = f"more than {number(limits[rank - 1])}" if rank else ""
    high = f"at most {number(limits[rank])}" if rank < len(limits) - 1 else ""
    return f"{' and '.join(part for part in (low, high) if part)} is spent"
