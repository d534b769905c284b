"""A policy that can be asked what to do, and what that is worth."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

from statehtn.counted import counted
from statehtn.errors import UsageError
from statehtn.expected import expect, items, number, shown, whole_number
from statehtn.model.plan import MOST_RUNS, Plan, Step
from statehtn.model.policy_graph import Decision, End, PolicyGraph, PolicyNode
from statehtn.model.problem import Fact, Problem
from statehtn.policies.chain import Chain
from statehtn.policies.entries import node_entry
from statehtn.policies.simulation import SimulatedRuns, simulate
from statehtn.policies.total_cost import PolicyCost
from statehtn.policies.trajectory import Trajectory, drawn
from statehtn.risk import Success
from statehtn.risk.policy_objectives import PolicyObjective

if TYPE_CHECKING:
    from statehtn.model.decomposition_tree import DecompositionTree

Network = tuple[tuple[Step, ...], tuple[tuple[int, int], ...]]
"""A remaining network: its tasks, and pairs (i, j) of their indices, i before j."""
PlanOf = Callable[[Sequence[int]], Plan]
"""Returns the plan, with its decomposition, along branches of a policy from its beginning on."""


class Policy:
    """What to do in every state and with every remaining network that can come up.

    Every value is worked out from the decisions and their branches, by code that the search does not use.

    Args:
        problem: the problem that it was made for.
        graph: the decisions.
        objective: what policies are compared by.
        failure_cost: what a run pays that fails, on top of what it has spent; None where failing is not paid for.
        plan_of: returns the plan along branches; None where decompositions are not known.
    """

    def __init__(
        self,
        problem: Problem,
        graph: PolicyGraph,
        objective: PolicyObjective,
        failure_cost: float | None = None,
        plan_of: PlanOf | None = None,
    ) -> None:
        self.problem = problem
        self.graph = graph
        self.objective = objective
        self.failure_cost = failure_cost
        self._plan_of = plan_of

    def __repr__(self) -> str:
        return f"<policy of {counted(len(self.graph), 'node')} by '{self.objective}'>"

    def __str__(self) -> str:
        from statehtn.display.policy_tree import policy_text

        return policy_text(self.graph)

    def _repr_html_(self) -> str:
        from statehtn.display.policy_tree import policy_html

        return policy_html(self.graph)

    def __len__(self) -> int:
        return len(self.graph)

    @property
    def start(self) -> PolicyNode:
        """The node at which every run begins."""
        return self.graph.nodes[0]

    def decide(self, state: Iterable[Fact], network: Network, spent: float = 0.0) -> Decision | End:
        """Return what to do in a state with a remaining network, or why there is nothing to do.

        Args:
            state: the facts that hold, such as `("at", "truck", "depot")`; others may be among them.
            network: what remains to be done, as `network_of` a node of the policy says it.
            spent: what has been paid up to now, in the domain's unit; it matters to agents that look at it.

        Raises:
            UsageError: a run of this policy never comes to this state with this network, or these are none.
        """
        facts = frozenset(map(tuple, items(state, "the state")))
        budget = number(spent, "what was spent")
        if not budget >= 0:
            raise UsageError(f"what was spent must be at least 0, found {budget:g}")
        if not (isinstance(network, tuple) and len(network) == 2):
            raise UsageError(
                f"a network is a pair of tasks and their order, as network_of() returns it, found {shown(network)}"
            )
        found = [
            node
            for index in self._by_network.get(_sorted(network), ())
            if (node := self.graph.nodes[index]).facts == (facts if node.known is None else facts & node.known)
            or (node.known is None and node.facts == facts & self._facts)
        ]
        if not found:
            raise UsageError("no run of this policy comes to this state with this network; plan from there anew")
        # What a node forgets is out of its reach; where more is known, more may be within reach.
        most = max(len(node.known or ()) for node in found)
        found = [node for node in found if len(node.known or ()) == most]
        node = _with_left(found, self.start.left, budget)
        if node.decision is not None:
            return node.decision
        assert node.end is not None
        return node.end

    @staticmethod
    def network_of(node: PolicyNode) -> Network:
        """Return the remaining network of a node."""
        return node.tasks, node.order

    @cached_property
    def _facts(self) -> frozenset[Fact]:
        """The ground facts of all nodes."""
        return frozenset().union(*(node.facts for node in self.graph.nodes))

    @cached_property
    def _by_network(self) -> dict[Network, list[int]]:
        found: dict[Network, list[int]] = {}
        for index, node in enumerate(self.graph.nodes):
            found.setdefault(_sorted((node.tasks, node.order)), []).append(index)
        return found

    @cached_property
    def _chain(self) -> Chain:
        return Chain(self.graph.flat)

    @cached_property
    def _cost(self) -> PolicyCost:
        return PolicyCost(self._chain, self.failure_cost or 0.0)

    def cost_distribution(self) -> PolicyCost:
        """Return the law of the total cost of its runs: positive, in the domain's unit.

        A run that fails costs what it has spent and the failure cost; `failed` of the law is how likely that is, and
        `given_done` the law among the others.
        """
        return self._cost

    @property
    def success_probability(self) -> float:
        """The probability of being done, 1 only where that is certain; a run without an end has failed."""
        return self._chain.success_probability()

    @property
    def failure_probability(self) -> float:
        """The probability of not being done, right however small it is."""
        return self._chain.failure_probability()

    @property
    def expected_cost(self) -> float:
        """The expected total cost of a run, failure costs included; may be infinite."""
        return self._cost.mean

    @property
    def value(self) -> float:
        """What it is worth by its objective, in the objective's unit; of `success` the probability of being done.

        Raises:
            InputError: it is infinite.
            UnsupportedError: it depends on the law of the total cost, which has too many values.
        """
        if isinstance(self.objective, Success):
            return self.success_probability
        return self.objective.value(self._cost)

    def simulate(self, runs: int, seed: int = 0) -> SimulatedRuns:
        """Draw so many independent runs by numpy's default generator; the same seed draws the same runs.

        Raises:
            UsageError: there is not at least one run.
        """
        import numpy

        if not 1 <= whole_number(runs, "the number of runs") <= MOST_RUNS:
            raise UsageError(f"the number of runs must be from 1 to {MOST_RUNS}, found {runs}")
        return simulate(self._chain, runs, numpy.random.default_rng(_checked_seed(seed)), self.failure_cost or 0.0)

    def trajectory(self, seed: int = 0) -> Trajectory:
        """Draw one run, with what was done and what came of it; the same seed draws the same run."""
        import numpy

        return drawn(self.graph, numpy.random.default_rng(_checked_seed(seed)))

    def plan(self, trajectory: Trajectory) -> Plan:
        """Return the actions of a run that is done, and the decomposition that they come from, as a plan.

        Raises:
            UsageError: the run is not done, or is none of this policy.
        """
        expect(trajectory, Trajectory, "expected a run of the policy", "policy.trajectory(seed) draws one")
        if trajectory.graph is not self.graph:
            raise UsageError("this is a run of another policy")
        if trajectory.end is not End.DONE:
            raise UsageError("only a run that is done has a decomposition of the whole network")
        if self._plan_of is None:
            raise UsageError("this policy was made without a problem, so that its decompositions are not known")
        return self._plan_of(trajectory.branches)

    def decomposition(self, trajectory: Trajectory) -> DecompositionTree:
        """Return how the actions of a run that is done come from the initial network.

        Raises:
            UsageError: the run is not done, or is none of this policy.
        """
        return self.plan(trajectory).decomposition

    def to_dict(self) -> dict[str, Any]:
        """Return the entry `policy` of the JSON object: the nodes, each with its decision."""
        return {"nodes": list(map(node_entry, self.graph.nodes))}


def _with_left(nodes: Sequence[PolicyNode], begin: float | None, spent: float) -> PolicyNode:
    """Return the node for an amount: the one with the most left that is not more than there is."""
    if begin is None or nodes[0].left is None:
        return nodes[0]
    left = begin - spent
    slack = 1e-9 * max(1.0, abs(left))
    below = [node for node in nodes if node.left is not None and node.left <= left + slack]
    return max(below or nodes, key=lambda node: (node.left or 0.0) * (1 if below else -1))


def _sorted(network: Network) -> Network:
    """Return a network with its tasks in an order that does not depend on how they are listed."""
    tasks, order = network
    places = sorted(range(len(tasks)), key=lambda place: (tasks[place].action, tasks[place].arguments))
    new = {old: place for place, old in enumerate(places)}
    return tuple(tasks[place] for place in places), tuple(sorted((new[i], new[j]) for i, j in order))


def _checked_seed(seed: int) -> int:
    if whole_number(seed, "the seed") < 0:
        raise UsageError(f"the seed must be at least 0, found {seed}")
    return seed
