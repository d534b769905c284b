"""Random small graphs of decisions and chances, for Hypothesis: with circles, free ones, too, and dead ends."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import strategies as st

from tests.explicit_graph import Branch, ExplicitGraph
from tests.strategies import Draw, between, pick

PROBABILITIES = tuple(
    tuple(map(Fraction, several.split()))
    for several in ("1", "0.5 0.5", "0.9 0.1", "0.25 0.75", "0.2 0.3 0.5", "0.1 0.8 0.1", "1/3 2/3")
)
COSTS = tuple(map(Fraction, ("0", "0", "1", "1", "2", "0.5", "3")))
ALPHAS = ("0.1", "0.3", "0.7", "1.5")
LEVELS = ("0.3", "0.5", "0.8", "0.9", "0.99")
BUDGETS = ("0", "1", "2", "3.5", "5", "8")
FAILURE_COSTS = tuple(map(Fraction, ("0", "1", "2.5", "6", "20")))


@st.composite
def decision_graphs(draw: Draw, most_nodes: int = 6, forward: bool = False) -> ExplicitGraph:
    """A graph; `forward` means one without circles."""
    graph = ExplicitGraph()
    count = between(draw, 1, most_nodes)
    for number in range(count):
        graph.add(f"n{number}")
    done = graph.add("done", True)
    for number in range(count):
        successors = [*range(number + 1, count), done, done] if forward else [*range(count), done, done]
        for _ in range(pick(draw, (1, 2, 2, 3, 0))):
            branches: dict[tuple[Fraction, int], Fraction] = {}
            for probability in pick(draw, PROBABILITIES):
                key = (pick(draw, COSTS), pick(draw, successors))
                branches[key] = branches.get(key, Fraction(0)) + probability
            graph.decisions[number].append(tuple(Branch(p, cost, to) for (cost, to), p in branches.items()))
    return graph


def exponential_texts() -> st.SearchStrategy[str]:
    """Objectives to which the amount spent does not matter."""
    agents = st.builds("{} {}".format, st.sampled_from(("averse", "seeking")), st.sampled_from(ALPHAS))
    return st.one_of(st.just("neutral"), st.just("success"), agents)


def memory_texts() -> st.SearchStrategy[str]:
    """Objectives to which it matters up to some amount."""
    budgets, levels = st.sampled_from(BUDGETS), st.sampled_from(LEVELS)
    return st.one_of(
        st.builds("deadline {}".format, budgets),
        st.builds("overrun {}".format, budgets),
        st.builds("quantile {}".format, levels),
        st.builds("cvar {}".format, levels),
        st.builds("mean-cvar {} {}".format, levels, st.sampled_from(("0.25", "0.5", "1"))),
        st.builds(
            "piecewise 0:0 {}:{} {}:{}".format,
            st.just("2"),
            st.sampled_from(("0", "-1", "-4")),
            st.just("5"),
            st.sampled_from(("-4", "-5", "-9")),
        ),
    )


def one_switch_texts() -> st.SearchStrategy[str]:
    """Objectives to which it matters always."""
    small = st.sampled_from(("0.1", "0.3", "0.5"))
    switch = st.builds(
        "one-switch alpha={} tradeoff={} wealth={}".format,
        small,
        st.sampled_from(("0.1", "1")),
        st.sampled_from(("0", "5")),
    )
    sums = st.builds(
        "exponentials linear={} {}:{} {}:1".format,
        st.sampled_from(("0", "1")),
        small,
        st.sampled_from(("1", "0.1")),
        st.sampled_from(("-0.2", "-0.5")),
    )
    return st.one_of(switch, sums)
