"""The decomposition of a plan in numbers."""

from __future__ import annotations

from statehtn.model.plan import Decomposition, Plan
from statehtn.semantics.world import World


class PlanTree:
    """The compound nodes of a plan's decomposition, numbered so that parents come before their children.

    Node 0 stands for the initial network.

    Args:
        plan: the plan.
        world: its limits hold.
    """

    def __init__(self, plan: Plan, world: World) -> None:
        self.plan = plan
        self.nodes: list[Decomposition | None] = [None]
        """By number; None for the initial network."""
        self.children: list[list[int]] = []
        """By number: steps by their index in the plan (its length for an index that it does not have), nodes by the
        bitwise complement of their number."""
        nodes, length = self.nodes, len(plan.steps)
        for node in nodes:  # which grows
            world.work()
            entries: list[int] = []
            for child in plan.roots if node is None else node.children:
                if isinstance(child, Decomposition):
                    entries.append(~len(nodes))
                    nodes.append(child)
                else:
                    entries.append(child if 0 <= child < length else length)
            self.children.append(entries)

    def first_steps(self) -> list[int | None]:
        """Return for every node the first step below it; None if there is none."""
        found: list[int | None] = [None] * len(self.nodes)
        for number in range(len(self.nodes) - 1, -1, -1):
            first: int | None = None
            for child in self.children[number]:
                step = child if child >= 0 else found[~child]
                if step is not None and (first is None or step < first):
                    first = step
            found[number] = first
        return found
