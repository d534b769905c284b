"""Why a problem has no plan: what cannot be done, down to the roots; and why a given plan is not the one."""

from statehtn.explanation.ask import why
from statehtn.explanation.explanation import NoPlan
from statehtn.explanation.given_plan import WhyNot

__all__ = ["NoPlan", "WhyNot", "why"]
