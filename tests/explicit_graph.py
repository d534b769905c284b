"""The whole graph of what an agent can decide and chance can do in a small problem, from its lifted form.

A node is a state and a network of what is still to do. Whatever in the network has nothing before it may come next: an
action is executed, a condition tested, a compound task decomposed, in every possible way: that is the agent's decision.
Every outcome of an action, and every cost that it may have then, is a branch. Nothing is shared with the planner.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from statehtn.model import Problem, Step
from tests.brute_force import Canonical, Condition, Event, GaveUp, Node, Space, replaced
from tests.naive_outcomes import ways

MOST_NODES = 400
BRANCHES = 15  # for each node, at most
LARGEST_NETWORK = 7


@dataclass(frozen=True)
class Branch:
    """What may come after a decision: how likely, what it costs, and where it leads."""

    probability: Fraction
    cost: Fraction
    successor: int


Decision = tuple[Branch, ...]


@dataclass
class ExplicitGraph:
    """Nodes by number, 0 the first: which are done, and what can be decided in each.

    Where all is decided already, in a policy's graph, the agent gives up only at nodes without a decision.
    """

    done: list[bool] = field(default_factory=list)
    decisions: list[list[Decision]] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    is_policy: bool = False

    def can_stop(self, node: int) -> bool:
        return not (self.is_policy and self.decisions[node])

    def add(self, name: str, done: bool = False) -> int:
        self.done.append(done)
        self.decisions.append([])
        self.names.append(name)
        return len(self.done) - 1

    @property
    def costs(self) -> set[Fraction]:
        """All costs that a step may have."""
        return {branch.cost for node in self.decisions for decision in node for branch in decision}

    def __repr__(self) -> str:
        lines = []
        for number, decisions in enumerate(self.decisions):
            lines.append(f"{number} {self.names[number]}{' done' if self.done[number] else ''}")
            lines += [
                "  " + ", ".join(f"{b.probability} costs {b.cost} to {b.successor}" for b in d) for d in decisions
            ]
        return "\n".join(lines)


def graph_of(decisions: Mapping[str, Sequence[Sequence[tuple[str, str, str]]]], done: str = "done") -> ExplicitGraph:
    """A graph by hand: for each node, the first first, its decisions of branches (probability, cost, successor)."""
    graph = ExplicitGraph()
    numbers = {name: graph.add(name) for name in decisions}
    numbers[done] = graph.add(done, True)
    for name, several in decisions.items():
        for decision in several:
            branches = tuple(Branch(Fraction(p), Fraction(cost), numbers[to]) for p, cost, to in decision)
            assert sum(branch.probability for branch in branches) == 1
            graph.decisions[numbers[name]].append(branches)
    return graph


def explicit_graph(
    problem: Problem,
    most_nodes: int = MOST_NODES,
    largest_network: int = LARGEST_NETWORK,
    decomposes_first: bool = False,
) -> ExplicitGraph:
    """The graph of a problem.

    Args:
        problem: a small one.
        most_nodes: how many nodes the graph may have.
        largest_network: how many tasks a network may have: recursion without end makes ever larger ones.
        decomposes_first: whether the agent must decompose a compound task as soon as it can, and of several the first:
            for agents that look at what happens that is a loss.

    Raises:
        GaveUp: it is larger, or has BRANCHES times as many branches as nodes are allowed.
    """
    space, canonical = Space(problem), Canonical()
    graph = ExplicitGraph()
    numbers: dict[object, int] = {}
    pending: list[tuple[int, Node]] = []
    count = 0

    def number_of(node: Node) -> int:
        key = (node.state, canonical(node.network))
        if key not in numbers:
            if len(graph.done) >= most_nodes or len(node.network) > largest_network:
                raise GaveUp
            name = f"{{{' '.join(sorted(map(str, node.state)))}}} {[part.label for part in node.network]}"
            numbers[key] = graph.add(name, space.is_goal(node))
            pending.append((numbers[key], node))
        return numbers[key]

    first = graph.add("the choice of the first network")
    for root in space.roots():
        graph.decisions[first].append((Branch(Fraction(1), Fraction(0), number_of(root)),))
    while pending:
        number, node = pending.pop()
        for results in decisions_of(space, node, decomposes_first):
            together: dict[tuple[Fraction, int], Fraction] = {}
            for probability, cost, successor in results:
                key = (cost, number_of(successor))
                together[key] = together.get(key, Fraction(0)) + probability
            decision = tuple(Branch(p, cost, successor) for (cost, successor), p in together.items())
            count += len(decision)
            if count > BRANCHES * most_nodes:
                raise GaveUp
            if decision not in graph.decisions[number]:
                graph.decisions[number].append(decision)
    return graph


def decisions_of(
    space: Space, node: Node, decomposes_first: bool = False
) -> Iterator[list[tuple[Fraction, Fraction, Node]]]:
    """All decisions in a node: what each may lead to, with probability and cost."""
    one, nothing = Fraction(1), Fraction(0)
    parts = [part for part in node.network if not part.before]
    if decomposes_first:
        tasks = space.problem.domain.tasks
        compound = [part for part in parts if not isinstance(part, Condition) and part.name in tasks]
        parts = [*compound[:1]] or parts
    for part in parts:
        if isinstance(part, Condition):
            if space.semantics.holds(part.formula, dict(part.bindings), node.state):
                yield [(one, nothing, Node(node.state, replaced(node.network, part, []), node.last))]
        elif part.name in space.problem.domain.actions:
            found = ways(space.semantics, part.name, part.arguments, node.state)
            if found is not None:
                network = replaced(node.network, part, [])
                last = Event(part.path, node.last, step=Step(part.name, part.arguments))
                yield [
                    (way.probability * probability, cost, Node(way.state(node.state), network, last))
                    for way in found
                    for cost, probability in way.law.items()
                    if probability
                ]
        else:
            yield from ([(one, nothing, successor)] for successor in space.decompositions(node, part))
