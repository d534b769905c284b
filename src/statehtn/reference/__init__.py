"""The paper's algorithms as executable pseudo-code: slow, readable, open to any heuristic.

- Algorithms 1 and 2, the values of the plan-based solver: `compute_task_eu.py`.
- Algorithm 3, the plan-based solver: `plan_based.py`.
- Algorithm 4, FindPlans, the state-based solver: `find_plans.py`.
- Algorithm 5, computeRCAdHeur, its heuristic: `compute_rc_ad_heur.py`.

`find_plans(ground(problem, switches=PLAIN).to_model(), utility, hmax)` solves a problem, with `ground` and `PLAIN` from
`statehtn.core.grounding`.
"""

from __future__ import annotations

from statehtn.reference.compute_rc_ad_heur import Heuristic, blind, compute_rc_ad_heur
from statehtn.reference.compute_task_eu import compute_task_eu, compute_utilities
from statehtn.reference.find_plans import find_plans, successors
from statehtn.reference.hmax import hmax
from statehtn.reference.lm_cut import lm_cut
from statehtn.reference.plan_based import plan_based
from statehtn.reference.relaxed_model import RelaxedFact, RelaxedOperator, RelaxedTask, build_rc_model
from statehtn.reference.search_node import SearchNode, Solution

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
    "compute_task_eu",
    "compute_utilities",
    "find_plans",
    "hmax",
    "lm_cut",
    "plan_based",
    "successors",
]
