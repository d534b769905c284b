"""Checks plans and their decompositions against the lifted model; shares no code with grounding or search."""

from statehtn.validate.validation import Validation, validate

__all__ = ["Validation", "validate"]
