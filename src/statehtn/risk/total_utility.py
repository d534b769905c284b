"""What utilities of a plan's total cost have in common that are neither linear nor exponential."""

from __future__ import annotations

from statehtn.risk.utility import FunctionType, PlanUtility


class TotalUtility:
    """An objective that orders plans by the expected utility of their total cost, which no prices of actions determine.

    It only says where the paper's RA-parameters put it: equation 4 defines the expected utility of a plan, and neither
    of the shorter forms holds.
    """

    __slots__ = ()

    is_dynamic = False
    """Whether the attitude to risk changes with what is left (the RA-parameter `k`)."""
    function_type = FunctionType.OTHER
    allows_segmentation = False
    plan_utility = PlanUtility.TRAJECTORIES
