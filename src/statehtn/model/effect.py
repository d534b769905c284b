"""Effects of lifted actions."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.model.formula import TRUE, Atom, Formula
from statehtn.model.types import Parameter


@dataclass(frozen=True, slots=True)
class Effect:
    """One literal that an action makes true or false, for all bindings of `parameters` under which `condition` holds.

    Conditions are evaluated in the state before the action; what is added wins over what is deleted.
    """

    atom: Atom
    positive: bool = True
    condition: Formula = TRUE
    parameters: tuple[Parameter, ...] = ()
