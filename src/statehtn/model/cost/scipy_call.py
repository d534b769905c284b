"""Calls of scipy: what it raises becomes an error of ours that names the law, and what it remarks is not shown."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from statehtn.errors import InputError, StateHtnError

# What numerical code raises: AxisError of numpy is a ValueError, errors of the libraries below are ArithmeticErrors or
# RuntimeErrors. Interruptions, limits and a memory that is used up pass.
NUMERICAL_ERRORS = (ArithmeticError, ValueError, TypeError, LookupError, AttributeError, RuntimeError)


@contextmanager
def scipy_call(law: str) -> Iterator[None]:
    """Let scipy compute something about a law.

    Raises:
        InputError: scipy failed; the message names the law, and says what to do.
    """
    import numpy

    with warnings.catch_warnings(), numpy.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            yield
        except StateHtnError:
            raise
        except NUMERICAL_ERRORS as error:
            reason = " ".join(f"{type(error).__name__}: {error}".split())
            raise InputError(
                f"scipy.stats fails on {law} ({reason:.200}); check its parameters, or give outcomes or samples instead"
            ) from None
