"""The judge of policies is judged: by hand, by the known formulas, and by all policies of small graphs."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.brute_force import GaveUp
from tests.exact_laws import Law, Laws
from tests.exact_objectives import exact_objective
from tests.explicit_evar import best_policy_by_evar
from tests.explicit_exponentials import best_policy_for_exponentials
from tests.explicit_graph import ExplicitGraph, graph_of
from tests.explicit_memory import INFINITE, best_policy_with_memory
from tests.explicit_policies import Answer, best_policy
from tests.random_graphs import decision_graphs, exponential_texts, memory_texts, one_switch_texts

HALF = "0.5"
MOST_LAWS = 500
Mixture = frozenset[tuple[Fraction, Fraction]]


def steps(*rows: tuple[str, str, str]) -> list[list[tuple[str, str, str]]]:
    """The only decision of a node."""
    return [list(rows)]


RETRY = graph_of({"try": steps((HALF, "1", "try"), (HALF, "1", "carry")), "carry": steps(("1", "3", "done"))})


def test_a_retry_loop() -> None:
    assert best_policy(RETRY, "neutral").value == 5
    half = math.exp(0.3) / 2
    assert best_policy(RETRY, "averse 0.3").value == pytest.approx(math.log(half / (1 - half)) / 0.3 + 3, rel=1e-15)
    assert best_policy(RETRY, "averse 0.7").value is None  # e^0.7 / 2 > 1
    half = math.exp(-0.7) / 2
    assert best_policy(RETRY, "seeking 0.7").value == pytest.approx(-math.log(half / (1 - half)) / 0.7 + 3, rel=1e-15)
    assert best_policy(RETRY, "success") == Answer(Fraction(1), Fraction(5))
    for tries in range(6):
        late = best_policy_with_memory(RETRY, f"deadline {3 + tries}").value
        assert late == Fraction(1, 2) ** tries
    assert best_policy_with_memory(RETRY, "quantile 0.75").value == 5
    assert best_policy_with_memory(RETRY, "overrun 4").value == 1
    assert best_policy_with_memory(RETRY, "cvar 0.5").value == 6


def test_giving_up_has_a_price() -> None:
    """The averse agent tries until that costs too much; what it has spent does not matter to it."""
    failure = Fraction(10)
    assert best_policy(RETRY, "neutral", Fraction(4)).value == 4
    assert best_policy(RETRY, "averse 0.7", failure).value == 10
    assert best_policy_with_memory(RETRY, "deadline 4", failure).value == Fraction(1, 2)
    assert best_policy_with_memory(RETRY, "deadline 4", INFINITE).value == Fraction(1, 2)


def test_a_free_loop_is_worth_what_leaves_it() -> None:
    free = graph_of({"a": [[("1", "0", "b")], [("1", "4", "done")]], "b": [[("1", "0", "a")], [("1", "7", "done")]]})
    for text in ("neutral", "averse 0.5", "seeking 0.5"):
        assert best_policy(free, text).value == pytest.approx(4, rel=1e-30)
    assert best_policy_with_memory(free, "overrun 1").value == 3
    nowhere = graph_of({"a": [[("1", "0", "b")]], "b": [[("1", "0", "a")]]})
    assert best_policy(nowhere, "neutral").value is None
    assert best_policy(nowhere, "success").value == 0


def test_not_done_with_probability_one() -> None:
    """The seeking agent's value of a gamble that may fail is finite; only the dear way counts."""
    gamble = steps((HALF, "1", "done"), (HALF, "1", "stuck"))
    graph = graph_of({"start": [*gamble, [("1", "9", "done")]], "stuck": []})
    assert best_policy(graph, "seeking 0.5").value == pytest.approx(9, rel=1e-30)
    assert best_policy(graph, "neutral").value == 9
    assert best_policy(graph_of({"start": gamble, "stuck": []}), "seeking 0.5").value is None
    answer = best_policy(graph_of({"start": gamble, "stuck": []}), "success")
    assert answer == Answer(Fraction(1, 2), Fraction(1))
    loop = graph_of({"start": gamble, "stuck": steps(("1", "1", "stuck"))})
    assert best_policy(loop, "success").expected_cost == 1  # being done has become impossible: the agent stops


def test_waiting_for_a_cost() -> None:
    """The known answer of a choice that may wait for a cost elsewhere, with the deadline 8."""
    c1 = [(HALF, "0", ""), (HALF, "6", "")]
    x2 = [(HALF, "0", ""), (HALF, "9", "")]

    def after(branches: list[tuple[str, str, str]], node: str) -> list[tuple[str, str, str]]:
        return [(p, cost, node) for p, cost, _ in branches]

    other = [("1", "5", "done")], after(x2, "done")
    first = [after(c1, "choose"), [("1", "20", "choose")]]
    graph = graph_of(
        {
            "start": [*first, [("1", "5", "chosen")], after(x2, "chosen")],
            "choose": list(other),
            "chosen": [after(c1, "done"), [("1", "20", "done")]],
        }
    )
    assert best_policy_with_memory(graph, "deadline 8").value == Fraction(1, 4)
    fixed = graph_of({"start": [[("1", "5", "chosen")], after(x2, "chosen")], "chosen": [after(c1, "done")]})
    assert best_policy_with_memory(fixed, "deadline 8").value == Fraction(1, 2)


@pytest.mark.parametrize("size", [1, 2, 3, 8, 20])
def test_known_answers(size: int) -> None:
    chain = {f"s{i}": steps(("0.9", "1", f"s{i + 1}"), ("0.1", "1", "stuck")) for i in range(size)}
    chain[f"s{size - 1}"] = steps(("0.9", "1", "done"), ("0.1", "1", "stuck"))
    assert best_policy(graph_of({**chain, "stuck": []}), "success").value == Fraction(9, 10) ** size
    ways = [[(f"{i}/{i + 1}", "1", "done"), (f"1/{i + 1}", "1", "stuck")] for i in range(1, size + 1)]
    assert best_policy(graph_of({"s": ways, "stuck": []}), "success").value == Fraction(size, size + 1)
    tries = {f"s{i}": steps((HALF, "1", "done"), (HALF, "1", f"s{i + 1}")) for i in range(size)}
    answer = best_policy(graph_of({**tries, f"s{size}": []}), "success")
    assert answer.value == 1 - Fraction(1, 2) ** size
    assert answer.expected_cost == 2 * answer.value
    for r in (1, 2, 5):
        nodes: dict[str, list[list[tuple[str, str, str]]]] = {"stuck": []}
        for i in range(size):
            after = f"s{i + 1}-{r}" if i + 1 < size else "done"
            for left in range(1, r + 1):
                failed = f"s{i}-{left - 1}" if left > 1 else "stuck"
                risky = [("0.6", "1", after), ("0.4", "1", failed)]
                nodes[f"s{i}-{left}"] = [risky, [("0.85", "1", after), ("0.15", "1", "stuck")]]
        first = {f"s0-{r}": nodes[f"s0-{r}"]}
        answer = best_policy(graph_of({**first, **nodes}), "success")
        assert answer.value == (1 - Fraction(15, 100) * Fraction(4, 10) ** (r - 1)) ** size


@given(graph=decision_graphs(most_nodes=5), text=exponential_texts())
def test_against_all_policies(graph: ExplicitGraph, text: str) -> None:
    """Where the amount spent does not matter, one decision for each node is enough."""
    answer = best_policy(graph, text)
    values = [value_of(graph, policy, text) for policy in itertools.product(*map(range_of, graph.decisions))]
    least = min(values)
    if text == "success":
        assert answer.value == pytest.approx(-least, abs=1e-9)
    elif answer.value is None:
        assert least == math.inf
    else:
        assert float(answer.value) == pytest.approx(least, rel=1e-7, abs=1e-9)


def range_of(decisions: list[object]) -> range:
    return range(len(decisions) or 1)


def value_of(graph: ExplicitGraph, policy: tuple[int, ...], text: str) -> float:
    """The value of one policy in floats; infinite where it is not done with probability 1."""
    size = len(graph.done)
    reach = numpy.zeros((size, size))
    weights = numpy.zeros((size, size))
    name, *words = text.split()
    slope = {"averse": 1, "seeking": -1}.get(name, 0) * float(words[0] if words else 0)
    cost = numpy.zeros(size)
    for node, (decisions, number) in enumerate(zip(graph.decisions, policy, strict=True)):
        for branch in decisions[number] if decisions else ():
            reach[node, branch.successor] += float(branch.probability)
            weights[node, branch.successor] += float(branch.probability) * math.exp(slope * float(branch.cost))
            cost[node] += float(branch.probability * branch.cost)
    done = numpy.array(graph.done, dtype=float)
    seen, pending = {0}, [0]
    while pending:
        for successor in numpy.flatnonzero(reach[pending.pop()]):
            if successor not in seen:
                seen.add(int(successor))
                pending.append(int(successor))
    live = [node for node in range(size) if can_reach(reach, graph.done, node)]
    inner = [node for node in live if not graph.done[node]]
    chance = numpy.zeros(size)
    chance[list(numpy.flatnonzero(done))] = 1
    if inner:
        matrix = numpy.eye(len(inner)) - reach[numpy.ix_(inner, inner)]
        chance[inner] = numpy.linalg.solve(matrix, reach[inner] @ done)
    if name == "success":
        return -chance[0]
    if not seen <= set(live):
        return math.inf
    inner = sorted(seen - set(numpy.flatnonzero(done)))
    if not inner:
        return 0.0
    within = weights[numpy.ix_(inner, inner)]
    if max(abs(numpy.linalg.eigvals(within))) >= 1:
        return math.inf
    matrix = numpy.eye(len(inner)) - within
    constant = cost[inner] if name == "neutral" else weights[inner] @ done
    value = numpy.linalg.solve(matrix, constant)[inner.index(0)]
    return float(value if name == "neutral" else math.log(value) / slope)


def can_reach(reach: numpy.ndarray, done: list[bool], node: int) -> bool:
    seen, pending = {node}, [node]
    while pending:
        last = pending.pop()
        if done[last]:
            return True
        for successor in map(int, numpy.flatnonzero(reach[last])):
            if successor not in seen:
                seen.add(successor)
                pending.append(successor)
    return False


@given(graph=decision_graphs(most_nodes=5, forward=True), text=memory_texts())
def test_memory_against_all_histories(graph: ExplicitGraph, text: str) -> None:
    """Without circles: every history has its own decision, and all laws that come about so are compared."""
    laws = laws_of(graph)
    answer = best_policy_with_memory(graph, text)
    if not laws:
        assert answer.value is None
    else:
        value = exact_objective(text).value
        assert answer.value == min(value(law) for law in laws)


@given(graph=decision_graphs(most_nodes=5, forward=True), text=one_switch_texts())
def test_exponentials_against_all_histories(graph: ExplicitGraph, text: str) -> None:
    laws = laws_of(graph)
    answer = best_policy_for_exponentials(graph, text)
    if not laws:
        assert answer.value is None
    else:
        value = exact_objective(text).value
        assert float(answer.value) == pytest.approx(float(min(value(law) for law in laws)), rel=1e-10, abs=1e-10)


@settings(max_examples=10)
@given(graph=decision_graphs(most_nodes=4, forward=True), level=st.sampled_from(("0.5", "0.9")))
def test_evar_against_all_histories(graph: ExplicitGraph, level: str) -> None:
    """Policies that do not look at what was spent are enough: every agent of the family is such a one."""
    laws = laws_of(graph)
    answer = best_policy_by_evar(graph, f"evar {level}", close=1e-3)
    if not laws:
        assert answer.value is None
    else:
        least = min(exact_objective(f"evar {level}").value(law) for law in laws)
        assert float(least) - 1e-12 <= float(answer.value) <= float(least) + 1e-3 * max(1, least)


def laws_of(graph: ExplicitGraph) -> list[Law]:
    """All laws of the total cost of policies that are done with probability 1; a graph without circles."""
    known: dict[int, set[Mixture]] = {}
    laws = Laws()

    def of(node: int) -> set[Mixture]:
        if node not in known:
            known[node] = {frozenset({(Fraction(0), Fraction(1))})} if graph.done[node] else set()
            for decision in graph.decisions[node]:
                for chosen in itertools.product(*(of(branch.successor) for branch in decision)):
                    mixture: dict[Fraction, Fraction] = {}
                    for branch, law in zip(decision, chosen, strict=True):
                        for cost, p in law:
                            total = cost + branch.cost
                            mixture[total] = mixture.get(total, Fraction(0)) + p * branch.probability
                    known[node].add(frozenset(mixture.items()))
                    if len(known[node]) > MOST_LAWS:
                        raise GaveUp
        return known[node]

    return [laws.of(dict(law)) for law in of(0)]
