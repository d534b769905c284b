"""The paper's state-based solver as executable pseudo-code (Algorithms 4 and 5): slow, readable, open to any heuristic.

`find_plans(ground(problem, switches=PLAIN).to_model(), utility, hmax)` solves a problem, with `ground` and `PLAIN` from
`statehtn.core.grounding`.
"""

from __future__ import annotations

from statehtn.reference.compute_rc_ad_heur import Heuristic, blind, compute_rc_ad_heur
from statehtn.reference.find_plans import SearchNode, Solution, find_plans, successors
from statehtn.reference.hmax import hmax
from statehtn.reference.relaxed_model import RelaxedFact, RelaxedOperator, RelaxedTask, build_rc_model

__all__ = [
    "Heuristic",
    "RelaxedFact",
    "RelaxedOperator",
    "RelaxedTask",
    "SearchNode",
    "Solution",
    "blind",
    "build_rc_model",
    "compute_rc_ad_heur",
    "find_plans",
    "hmax",
    "successors",
]
