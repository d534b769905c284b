"""The probabilities of a block: they sum to at most 1, and with the rest nothing is done."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from statehtn.errors import InputError, Place
from statehtn.expected import shown_number
from statehtn.log import warn_caller
from statehtn.model.cost.blocks import PROBABILITY_TOLERANCE


class CostWarning(UserWarning):
    """A cost is defined, but perhaps not as it was meant."""


def completed(
    stated: Sequence[Fraction],
    what: tuple[str, str],
    action: tuple[str, str],
    place: Place | None,
    is_computed: bool,
) -> tuple[tuple[Fraction, ...], Fraction]:
    """Return the probabilities of a block's branches, and what is missing to 1.

    What is off by rounding only is spread over all branches.

    Args:
        stated: the probabilities, at least 0.
        what: whose probabilities they are, and what happens with the rest, for messages.
        action: the ground action, and the name of the lifted one.
        place: of the block.
        is_computed: whether some depend on parameters; the reader has seen the others, and warned of them.

    Raises:
        InputError: they sum to more than 1.
    """
    total = sum(stated, Fraction(0))
    if total > 1 + PROBABILITY_TOLERANCE:
        raise InputError(
            f"the probabilities of the {what[0]} of {action[0]} sum to {shown_number(total)}, more than 1; those of "
            f"one block must sum to 1",
            place,
        )
    if total >= 1 - PROBABILITY_TOLERANCE:
        exact = stated if total == 1 else [probability / total for probability in stated]
        return tuple(exact), Fraction(0)
    if is_computed:
        # Names the lifted action only, so that Python shows it once and not for every ground action.
        warn_caller(
            CostWarning(f"some probabilities of the {what[0]} of action '{action[1]}' sum to less than 1; {what[1]}")
        )
    return tuple(stated), 1 - total
