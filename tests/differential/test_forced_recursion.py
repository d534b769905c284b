"""Tasks that begin with themselves: forced steps that lead in a circle are dead ends, and nothing else is.

In total order, what a task can turn a state into is a finite table, so the optimum is known however tasks recur.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import Problem, Status, read_hddl_text, validate
from statehtn.core.grounding import ground
from statehtn.core.search import find_plans
from statehtn.core.searches import SEARCHES
from statehtn.core.switches import SearchSwitches
from statehtn.risk import utility_for
from tests.differential.oracles import LIMITS, close_to, must_have_ended

FACTS = ("p", "q")
TASKS = ("t0", "t1")
State = frozenset[str]
Literals = tuple[tuple[str, bool], ...]


@dataclass(frozen=True)
class Recursion:
    """Actions as (precondition, effect), methods of each task as sequences of tasks and actions."""

    actions: dict[str, tuple[Literals, Literals]]
    methods: dict[str, tuple[tuple[str, ...], ...]]
    initial: State
    goal: Literals

    def problem(self) -> Problem:
        def formula(literals: Literals) -> str:
            return f"(and {' '.join(f'({fact})' if holds else f'(not ({fact}))' for fact, holds in literals)})"

        actions = " ".join(
            f"(:action {name} :parameters () :precondition {formula(needed)} :effect {formula(made)})"
            for name, (needed, made) in self.actions.items()
        )
        methods = " ".join(
            f"(:method {task}-{index} :parameters () :task ({task}) "
            f":ordered-subtasks (and {' '.join(f'({subtask})' for subtask in subtasks)}))"
            for task, all_of_them in self.methods.items()
            for index, subtasks in enumerate(all_of_them)
        )
        domain = f"""(define (domain recursion) (:predicates {" ".join(f"({fact})" for fact in FACTS)})
            {" ".join(f"(:task {task} :parameters ())" for task in TASKS)} {methods} {actions})"""
        problem = f"""(define (problem p) (:domain recursion) (:htn :parameters () :subtasks (and (t0)))
            (:init {" ".join(f"({fact})" for fact in sorted(self.initial))}) (:goal {formula(self.goal)}))"""
        return read_hddl_text(domain, problem)

    def optimum(self) -> float:
        """The fewest actions; infinity where there is no plan."""
        states = [frozenset(chosen) for n in range(3) for chosen in itertools.combinations(FACTS, n)]
        table: dict[tuple[str, State], dict[State, float]] = {(task, s): {} for task in TASKS for s in states}
        for name, (needed, made) in self.actions.items():
            for state in states:
                after = (state | {fact for fact, holds in made if holds}) - {fact for fact, holds in made if not holds}
                table[name, state] = {after: 1.0} if satisfies(state, needed) else {}
        for _ in range(100):  # at most so many improvements follow one another
            for task, state in itertools.product(TASKS, states):
                for subtasks in self.methods[task]:
                    reached = {state: 0.0}
                    for subtask in subtasks:
                        reached = least(
                            (after, cost + more)
                            for before, cost in reached.items()
                            for after, more in table[subtask, before].items()
                        )
                    table[task, state] = least([*table[task, state].items(), *reached.items()])
        ends = [cost for state, cost in table["t0", self.initial].items() if satisfies(state, self.goal)]
        return min(ends, default=math.inf)


def satisfies(state: State, literals: Literals) -> bool:
    return all((fact in state) == holds for fact, holds in literals)


def least(costs) -> dict[State, float]:  # type: ignore[no-untyped-def]
    result: dict[State, float] = {}
    for state, cost in costs:
        result[state] = min(cost, result.get(state, math.inf))
    return result


def literals(most: int) -> st.SearchStrategy[Literals]:
    return st.dictionaries(st.sampled_from(FACTS), st.booleans(), max_size=most).map(lambda d: tuple(d.items()))


def recursions() -> st.SearchStrategy[Recursion]:
    actions = st.fixed_dictionaries({name: st.tuples(literals(2), literals(2)) for name in ("a", "b", "c")})
    # Recursion comes first more often than not.
    subtasks = st.tuples(
        st.sampled_from([(), ("t0",), ("t1",), ("t0",)]),
        st.lists(st.sampled_from(["a", "b", "c", "a", *TASKS]), max_size=3),
    ).map(lambda pair: (*pair[0], *pair[1]))
    methods = st.lists(subtasks, min_size=1, max_size=3).map(tuple)
    initial = st.sets(st.sampled_from(FACTS)).map(frozenset)
    return st.builds(Recursion, actions, st.fixed_dictionaries(dict.fromkeys(TASKS, methods)), initial, literals(1))


@pytest.mark.filterwarnings("ignore:.*there is no plan")
@pytest.mark.parametrize("search", SEARCHES)
@given(recursion=recursions(), follows=st.booleans())
def test_recursion_keeps_its_plans(search: str, recursion: Recursion, follows: bool) -> None:
    problem, utility = recursion.problem(), utility_for("neutral")
    outcome = find_plans(
        ground(problem),
        utility,
        search=search,
        weight=2.0,
        limits=LIMITS,
        switches=SearchSwitches(follow_forced=follows),
    )
    optimum = recursion.optimum()
    assert outcome.status is not Status.OPTIMAL or outcome.lower_bound == close_to(optimum)
    assert (outcome.status is Status.UNSOLVABLE) <= (optimum == math.inf)
    if outcome.plan is not None:
        assert validate(problem, outcome.plan).risk_cost(utility) >= optimum * (1 - 1e-9)
    must_have_ended(outcome.stopped)


LEFT_FIRST = Recursion(
    # Out of order: t0 can only begin with itself, since (not p) is needed for everything else.
    {"a": ((("p", False),), (("p", True),)), "b": ((("q", True),), (("q", False),)), "c": ((), (("p", False),))},
    {"t0": (("t0", "b", "t0"), ("a", "c", "c"), ("a", "t0", "t0")), "t1": (("t1", "t0", "b"), ("a", "t0"))},
    frozenset({"p", "q"}),
    (),
)


@pytest.mark.parametrize("search", SEARCHES)
@pytest.mark.parametrize("first", [("t0",), ("t1",)])
def test_forced_recursion_without_end_is_a_dead_end(search: str, first: tuple[str, ...]) -> None:
    methods = LEFT_FIRST.methods | ({} if first == ("t0",) else {"t0": (("t1", "b"), ("a", "c", "c"))})
    recursion = Recursion(LEFT_FIRST.actions, methods, LEFT_FIRST.initial, LEFT_FIRST.goal)
    assert recursion.optimum() == math.inf
    outcome = find_plans(ground(recursion.problem()), utility_for("neutral"), search=search, weight=2.0)
    assert outcome.status is Status.UNSOLVABLE
    assert outcome.effort.generated <= 2000  # not until sums of costs overflow
    assert 0 < outcome.effort.expanded <= 2000


@pytest.mark.parametrize("heuristic", ["auto", "blind", "tdg"])
def test_recursion_that_changes_the_state_is_no_cycle(heuristic: str) -> None:
    """There is but one way to go on, back to the same task, which then has another one."""
    recursion = Recursion(
        {"a": ((("p", False),), (("p", True),)), "b": ((("p", True),), (("q", True),)), "c": ((), ())},
        {"t0": (("a", "t0"), ("b",)), "t1": ((),)},
        frozenset(),
        (("q", True),),
    )
    outcome = find_plans(ground(recursion.problem()), utility_for("neutral"), heuristic=heuristic)
    assert outcome.status is Status.OPTIMAL
    assert outcome.lower_bound == close_to(recursion.optimum())
