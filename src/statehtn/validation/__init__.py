"""Checks plans and their decompositions against the lifted model; shares no code with grounding or search."""

from statehtn.validation.validation import Validation, execute_steps, validate, validate_trajectory

__all__ = ["Validation", "execute_steps", "validate", "validate_trajectory"]
