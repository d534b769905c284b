"""Outcomes in ground problems: their probabilities, their laws, what is refused, and what else meets them."""

from __future__ import annotations

from fractions import Fraction

import pytest

import statehtn
from statehtn import CostDistribution, Outcome, ProblemBuilder
from statehtn.build.cost_table import CostEntry, CostTable
from statehtn.core.grounding import PLAIN, ground
from statehtn.decomposition import ground_task_decomposition_graph, task_decomposition_graph
from statehtn.errors import InputError, UnsupportedError
from statehtn.hddl.reader import read_hddl_text
from statehtn.model import GroundAction, Problem, Step
from statehtn.model.cost.mixture import Mixture, mixture_of
from statehtn.model.cost.scenario_cost import ScenarioCost
from statehtn.reference.search_node import initial_node
from statehtn.semantics.outcomes import Transitions
from statehtn.semantics.world import World

DOMAIN = """(define (domain d) (:types block)
  (:predicates (held ?b - block) (wet ?b - block) (icy)) (:functions (p-slip ?b - block) (fee) - number)
  (:action lift :parameters (?b - block) :precondition (or (held ?b) (icy)))
  (:action grasp :parameters (?b - block) :effect EFFECT))"""
PROBLEM = """(define (problem p) (:domain d) (:objects a b - block)
  (:htn :ordered-subtasks (and (grasp a) (lift a))) (:init (= (p-slip a) 0.25) (= (p-slip b) 0.5) INIT))"""


def read(effect: str, init: str = "") -> Problem:
    """Return a problem of grasping with this effect, and lifting what is held."""
    return read_hddl_text(DOMAIN.replace("EFFECT", effect), PROBLEM.replace("INIT", init))


def grasps(problem: Problem) -> list[GroundAction]:
    """Return the outcome actions of grasping, likeliest first."""
    found = [action for action in ground(problem).to_model().actions if action.name == "grasp"]
    return sorted(found, key=lambda action: -action.probability)


def test_each_outcome_is_an_action_of_a_chance_task() -> None:
    problem = read("(and (increase (total-cost) 1) (probabilistic (p-slip ?b) () (- 1 (p-slip ?b)) (held ?b)))")
    held, slipped = grasps(problem)
    assert (held.probability, str(held.cost)) == (Fraction(3, 4), "1")
    assert (slipped.probability, str(slipped.cost), slipped.effects) == (Fraction(1, 4), "1", ())
    model = ground(problem, switches=PLAIN).to_model()
    (task,) = model.chance_tasks
    assert model.tasks[task - len(model.actions)] == ("grasp", "a")
    assert len(model.methods_of[task]) == 2


def test_outcomes_with_the_same_facts_have_the_mixture_as_their_law() -> None:
    held, other = grasps(
        read(
            """(and (probabilistic 0.3 (and (held ?b) (increase (total-cost) 1)) 0.3 (and (held ?b)
            (increase (total-cost) 3)) 0.4 (increase (total-cost) 2)) (increase (total-cost) 10))"""
        )
    )
    assert (held.probability, str(held.cost)) == (Fraction(3, 5), "11 w.p. 0.5, 13 w.p. 0.5")
    assert (other.probability, str(other.cost)) == (Fraction(2, 5), "12")


def test_an_action_whose_outcomes_nothing_reads_has_one_law() -> None:
    (only,) = grasps(
        read(
            "(and (held ?b) (probabilistic 0.5 (and (wet ?b) (increase (total-cost) 1)) 0.5 (increase (total-cost) 3)))"
        )
    )
    assert (only.probability, str(only.cost)) == (Fraction(1), "1 w.p. 0.5, 3 w.p. 0.5")


def test_conditional_costs_of_outcomes_are_parts_of_their_actions() -> None:
    held, _ = grasps(
        read("(probabilistic 0.6 (and (held ?b) (when (icy) (increase (total-cost) 5))) 0.4 (not (icy)))", "(icy)")
    )
    assert str(held.cost) == "0"
    assert [str(part.cost) for part in held.cost_parts] == ["5"]


def test_outcomes_with_the_same_facts_stay_apart_where_the_state_decides_what_one_costs() -> None:
    """One law of both would take the costs as independent of each other."""
    effect = """(probabilistic 0.5 (and (held ?b) (increase (total-cost) 1))
        0.3 (and (held ?b) (when (icy) (increase (total-cost) 5))) 0.2 (not (icy)))"""
    certain, conditional, _ = grasps(read(effect, "(icy)"))
    assert (certain.probability, str(certain.cost), certain.cost_parts) == (Fraction(1, 2), "1", ())
    assert (conditional.probability, str(conditional.cost)) == (Fraction(3, 10), "0")
    assert [str(part.cost) for part in conditional.cost_parts] == ["5"]


def test_costs_of_outcomes_with_the_same_facts_hang_together_with_others() -> None:
    effect = """(probabilistic 0.5 (and (held ?b) (when (icy) (increase (total-cost) 5)))
        0.3 (and (held ?b) (increase (total-cost) 1)) 0.2 (wet ?b))"""
    domain = DOMAIN.replace("EFFECT", effect).replace("(or (held ?b) (icy))", "(or (held ?b) (wet ?b))")
    problem = read_hddl_text(domain, PROBLEM.replace("INIT", "(probabilistic 0.5 (icy) 0.5 ())"))
    held, _ = grasps(problem)
    assert isinstance(held.cost, ScenarioCost)
    assert [str(law) for law in held.cost.laws] == ["1 w.p. 0.375, 5 w.p. 0.625", "0 w.p. 0.625, 1 w.p. 0.375"]
    assert ground(problem).has_scenarios
    found = Transitions(World(problem)).outcomes(Step("grasp", ("a",)), frozenset())
    assert found is not None
    assert held.cost in [outcome.law for outcome in found]


@pytest.mark.parametrize(
    ("effect", "message"),
    [
        ("(probabilistic (- (p-slip ?b) 0.5) (held ?b) 0.5 ())", "a probability must not be negative, found -0.25"),
        ("(probabilistic (* 5 (p-slip ?b)) (held ?b))", "the outcomes of (grasp a) sum to 1.25, more than 1"),
        ("(probabilistic (fee) (held ?b))", "the outcomes of (grasp a): the value of (fee) is not defined"),
    ],
)
def test_probabilities_that_are_none(effect: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        ground(read(effect))
    assert message in caught.value.message
    assert caught.value.place is not None
    assert caught.value.place.line == 4


def test_what_is_missing_to_probability_1_is_told() -> None:
    with pytest.warns(UserWarning, match=r"action 'grasp' sum to less than 1; with the rest nothing happens"):
        (nothing, held) = grasps(read("(probabilistic (p-slip ?b) (held ?b))"))
    assert (nothing.probability, held.probability) == (Fraction(3, 4), Fraction(1, 4))


def windows(count: int) -> Problem:
    """Return a problem in which each of so many windows is open by chance, and is shut."""
    names = [f"w{number}" for number in range(count)]
    domain = """(define (domain d) (:types window) (:predicates (open ?w - window))
  (:action blow :effect (forall (?w - window) (probabilistic 0.5 (open ?w) 0.5 ())))
  (:action shut :parameters (?w - window) :precondition (open ?w)))"""
    tasks = " ".join(f"(shut {name})" for name in names)
    return read_hddl_text(
        domain,
        f"(define (problem p) (:domain d) (:objects {' '.join(names)} - window) (:htn :subtasks (and (blow) {tasks})))",
    )


def test_up_to_64_outcomes_with_different_facts() -> None:
    assert sum(action.name == "blow" for action in ground(windows(6)).to_model().actions) == 64
    with pytest.raises(InputError, match=r"\(blow\) has more than 64 outcomes with different facts") as caught:
        ground(windows(7))
    assert caught.value.place is not None
    assert caught.value.place.line == 2


def test_callables_in_outcomes_become_tables() -> None:
    builder = ProblemBuilder("p", "d")
    (a,) = builder.type("block").objects("a")
    (b,) = builder.types["block"].variables("b")
    held = builder.predicate("held", b)

    def cost(name: str) -> CostDistribution:
        assert name == "a"
        return CostDistribution.of([(0.5, 1), (0.5, 2)])

    grasp = builder.action("grasp", [b], cost=lambda _: 3, outcomes=[Outcome(0.5, held(b), cost), Outcome(0.5)])
    lift = builder.action("lift", [b], precondition=held(b))
    builder.set_network([grasp(a), lift(a)])
    problem = statehtn.tabulate_costs(builder.build())
    assert read_hddl_text(*statehtn.write_hddl(problem)) == problem
    laws = {str(action.cost) for action in grasps(problem)}
    assert laws == {"3", "4 w.p. 0.5, 5 w.p. 0.5"} == {str(action.cost) for action in grasps(builder.build())}


def test_a_side_file_says_the_whole_cost() -> None:
    problem = read(
        "(and (increase (total-cost) 1) (probabilistic 0.6 (held ?b) 0.4 (and (wet ?b) (increase (total-cost) 2))))"
    )
    seven = CostEntry("costs.toml: entry 1", "grasp", ("a",), CostDistribution.certain(7))
    assert [str(action.cost) for action in grasps(CostTable((seven,)).apply(problem))] == ["7", "7"]
    other = CostEntry("costs.toml: entry 1", "grasp", ("b",), CostDistribution.certain(7))
    assert [str(action.cost) for action in grasps(CostTable((other,)).apply(problem))] == ["1", "3"]
    for all_of_them in (None, ("*",)):
        entry = CostEntry("costs.toml: entry 1", "grasp", all_of_them, CostDistribution.certain(7))
        assert [str(action.cost) for action in grasps(CostTable((entry,)).apply(problem))] == ["7", "7"]


def test_graphs_show_what_may_come() -> None:
    problem = read("(probabilistic 0.6 (held ?b) 0.4 (increase (total-cost) 2))")
    pytest.importorskip("networkx")
    graph = ground_task_decomposition_graph(ground(problem, switches=PLAIN).to_model())
    labels = {label for _, label in graph.nodes.data("label")}
    assert {"outcome w.p. 0.6", "outcome w.p. 0.4"} <= labels
    assert task_decomposition_graph(problem).nodes["task grasp"]["cost"] == "2 in an outcome w.p. 0.4"


def test_where_one_outcome_is_needed() -> None:
    problem = read("(probabilistic 0.6 (held ?b) 0.4 ())")
    with pytest.raises(ValueError, match="actions have one outcome"):
        initial_node(ground(problem, switches=PLAIN).to_model())
    pytest.importorskip("unified_planning")
    with pytest.raises(UnsupportedError, match="action 'grasp': it changes facts by chance"):
        statehtn.to_unified_planning(problem)


def test_mixtures_of_other_laws() -> None:
    scipy = pytest.importorskip("scipy.stats")
    uniform = CostDistribution.from_scipy(scipy.uniform(0, 2))
    one = CostDistribution.certain(1)
    assert mixture_of([1, 3], [one, CostDistribution.certain(1)]) is one
    law = mixture_of([1, 3], [CostDistribution.certain(4), uniform])
    assert isinstance(law, Mixture)
    assert law.mean == pytest.approx(1.75)
    assert (law.least, law.most) == (0, 4)
    assert law.cdf(1) == pytest.approx(0.375)
    assert law.exceedance(3) == pytest.approx(0.25)
    assert str(law) == "a mixture of 2 laws, from 0 to 4"
    with pytest.raises(UnsupportedError, match="ask for the laws that it mixes"):
        law.to_scipy()
