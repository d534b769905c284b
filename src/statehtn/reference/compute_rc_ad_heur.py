"""Algorithm 5 of the paper, computeRCAdHeur: an admissible classical heuristic on the relaxed model of a search node.

The numbers in the comments are the lines of the pseudo-code. Costs are positive and minimised here; the paper's are
negative and maximised. Line 6 differs from the paper: it prices an action by its risk cost, which adds up along a plan,
where the plain expected utility of an exponential utility does not. Parts of a cost that are due on a condition have
operators and prices of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from statehtn.model.ground import GroundProblem
from statehtn.reference.relaxed_model import RelaxedTask, build_rc_model
from statehtn.risk import Utility
from statehtn.risk.cost_shifting import shifted_prices

Heuristic = Callable[[RelaxedTask], float]
"""`computeH` of line 7: estimates the cost of the relaxed task's goals; infinite where they cannot be reached.

Any admissible heuristic for classical planning will do; one that uses operators of the same action twice over is not
admissible for actions with conditional effects.
"""


def compute_rc_ad_heur(
    state: frozenset[int],
    network_tasks: Iterable[int],
    problem: GroundProblem,
    utility: Utility,
    compute_h: Heuristic,
) -> float:
    """Return a lower bound on the risk cost that is still to come, in the domain's unit; infinite for a dead end.

    Args:
        state: the facts that hold in the node.
        network_tasks: the tasks of its network.
        problem: the ground problem (D and P of the paper).
        utility: the agent's (`P.utilityFunction`).
        compute_h: a classical heuristic.
    """
    model = build_rc_model(state, network_tasks, problem)  # 2
    for operator in model.operators:
        if operator.action is None:  # 3: for all A_m
            operator.cost = 0.0  # 4
    used = {operator.action for operator in model.operators if operator.action is not None}
    actions = {number: problem.actions[number] for number in used}
    prices = {number: shifted_prices(one.cost, one.cost_parts, utility) for number, one in actions.items()}
    for operator in model.operators:
        if operator.action is not None:  # 5: for all A
            own, parts = prices[operator.action]
            operator.cost = own if operator.part is None else parts[operator.part] if operator.is_due else 0.0  # 6
    return compute_h(model)  # 7, 8


def blind(task: RelaxedTask) -> float:
    """Return 0: no estimate at all."""
    del task
    return 0.0
