"""The readable landmark cuts lie where landmark cuts must lie, and lead the reference search to the optimum."""

from __future__ import annotations

from hypothesis import assume, given

from statehtn.core.grounding import PLAIN, ground
from statehtn.model import Problem
from statehtn.reference import RelaxedOperator, RelaxedTask, compute_rc_ad_heur, find_plans, hmax, lm_cut
from statehtn.risk import Utility, utility_for
from tests.differential.oracles import close_to
from tests.differential.test_heuristics_admissible import SLACK, relaxed_optimum
from tests.remaining_cost import explore
from tests.strategies import problems, utilities


@given(problem=problems(), utility=utilities())
def test_between_hmax_and_the_relaxed_optimum(problem: Problem, utility: Utility) -> None:
    model = ground(problem, switches=PLAIN).to_model()
    assume(model.methods)
    for node in explore(model, utility, most_nodes=15):
        value = compute_rc_ad_heur(node.state, node.tasks, model, utility, lm_cut)
        # hmax pays for each effect of an action that needs another one of it, a cut only once for the action.
        if all(len(action.effects) <= 1 for action in model.actions):
            assert value >= compute_rc_ad_heur(node.state, node.tasks, model, utility, hmax) * (1 - SLACK)
        assert value <= compute_rc_ad_heur(node.state, node.tasks, model, utility, relaxed_optimum) * (1 + SLACK)


def test_it_adds_what_hmax_does_not() -> None:
    """Two goals that nothing achieves together: hmax sees one of them, a landmark cut for each sees both."""

    def fact(number: int) -> tuple[str, int]:
        return ("holds", number)

    def operator(action: int, needs: int, adds: int, cost: float) -> RelaxedOperator:
        return RelaxedOperator(f"o{action}", frozenset([fact(needs)]), frozenset([fact(adds)]), action, cost=cost)

    operators = (operator(0, 0, 1, 2), operator(1, 0, 2, 3), operator(2, 1, 3, 4), operator(3, 2, 3, 1))
    facts = frozenset(map(fact, range(4)))
    task = RelaxedTask(facts, frozenset([fact(0)]), frozenset([fact(1), fact(3)]), operators)
    assert hmax(task) == 4
    assert lm_cut(task) == 6  # o0 for the one goal, o1 and o3 for the other


def test_it_expands_fewer_nodes_than_hmax(p1: Problem) -> None:
    model = ground(p1, switches=PLAIN).to_model()
    utility = utility_for("averse", 0.9)
    by_cuts, by_hmax = (find_plans(model, utility, heuristic) for heuristic in (lm_cut, hmax))
    assert by_cuts.risk_cost == close_to(by_hmax.risk_cost)
    assert by_cuts.expanded < by_hmax.expanded
