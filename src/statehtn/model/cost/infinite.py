"""Expectations that are infinite."""

from __future__ import annotations

from statehtn.errors import InputError


class InfiniteMean(InputError):
    """An expectation is infinite that has to be finite."""
