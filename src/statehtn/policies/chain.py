"""What runs of a policy are worth: sums over all of them, as solutions of linear equations.

Nothing here is shared with the search. A node's value follows from those of its successors; nodes that lead to each
other are solved together, after all that they lead to.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from functools import cached_property

from statehtn.model.cost.by_law import by_law
from statehtn.model.policy_graph import End, FlatPolicy
from statehtn.policies.components import components
from statehtn.policies.equations import MOST_DENSE, MUCH, log_sum, solution

NEARLY_NEUTRAL = 1e-3
"""Of a slope times the mean: below, an exponential is nearly a line."""
LARGEST_BELOW_1 = math.nextafter(1.0, 0.0)
ROUNDING = 1e-9
"""Of solutions relative to their largest: what is less than nothing by more than that has no meaning."""
RESIDUAL = 1e-6
"""Of each number of a solution: by so much it may miss its equation."""


class Chain:
    """The Markov chain of a policy's runs.

    Args:
        flat: the policy.
    """

    def __init__(self, flat: FlatPolicy) -> None:
        self.flat = flat
        self._means: dict[float, float] = {}

    @cached_property
    def order(self) -> list[list[int]]:
        """Nodes that lead to each other together, each such component after all that it leads to."""
        return components(self.flat.first, self.flat.successors)

    @cached_property
    def is_large(self) -> bool:
        """Whether there are many loops, or long ones."""
        return sum(len(component) ** 3 for component in self.order if len(component) <= MOST_DENSE) > MUCH

    def loops(self, component: Sequence[int]) -> bool:
        """Tell whether a run can come back to a component's nodes."""
        node = component[0]
        return len(component) > 1 or any(self.flat.successors[branch] == node for branch in self.flat.branches(node))

    def is_closed(self, component: Sequence[int]) -> bool:
        """Tell whether a component is a loop without a way out."""
        flat = self.flat
        inside = set(component)
        return flat.ends[component[0]] is None and all(
            flat.successors[branch] in inside for node in component for branch in flat.branches(node)
        )

    @cached_property
    def endless(self) -> bytearray:
        """For each node whether runs from it never end: all that it leads to comes to a loop without a way out."""
        flat = self.flat
        found = bytearray(len(flat))
        for component in self.order:
            inside = set(component)
            leaves = any(
                flat.ends[node] is not None
                or any(
                    (other := flat.successors[branch]) not in inside and not found[other]
                    for branch in flat.branches(node)
                )
                for node in component
            )
            for node in component if not leaves else ():
                found[node] = True
        return found

    @cached_property
    def stuck(self) -> bytearray:
        """For each node whether runs from it never end and pay nothing: they have failed there."""
        flat = self.flat
        found = bytearray(len(flat))
        for component in self.order:
            inside = set(component)
            branches = [branch for node in component for branch in flat.branches(node)]
            others = [flat.successors[branch] for branch in branches]
            is_free = all(flat.laws[branch].most == 0 for branch in branches)
            if self.endless[component[0]] and is_free and all(found[other] or other in inside for other in others):
                for node in component:
                    found[node] = True
        return found

    @cached_property
    def sure(self) -> bytearray:
        """For each node whether runs from it are done for certain: they come to no other end, and to no endless loop.

        Numbers would not tell: a loop may be left so seldom that rounding hides it.
        """
        flat, endless = self.flat, self.endless
        found = bytearray(end is End.DONE for end in flat.ends)
        for component in self.order:
            if flat.ends[component[0]] is not None or endless[component[0]]:
                continue
            inside = set(component)
            others = (flat.successors[branch] for node in component for branch in flat.branches(node))
            if all(found[other] or other in inside for other in others):
                for node in component:
                    found[node] = True
        return found

    def success_probability(self) -> float:
        """Return the probability that a run comes to its end: that it is done; 1 only where that is certain."""
        flat, sure = self.flat, self.sure
        if sure[0]:
            return 1.0
        values = [1.0 if is_sure else 0.0 for is_sure in sure]
        self._solve(values, flat.probabilities, [0.0] * len(flat), 0.0, sure)
        return min(LARGEST_BELOW_1, max(0.0, values[0]))

    def failure_probability(self) -> float:
        """Return the probability that a run is not done, right however small it is."""
        flat = self.flat
        values = self._end_values(1.0)
        self._solve(values, flat.probabilities, [0.0] * len(flat), 1.0, self.sure)
        return min(1.0, max(0.0, values[0]))

    def probability_of(self, branches: Collection[int]) -> float:
        """Return the probability that a run takes one of some branches, by indices, at least once.

        From the nodes of these branches a run must be able to come to an end.
        """
        flat = self.flat
        weights = [0.0 if branch in branches else p for branch, p in enumerate(flat.probabilities)]
        constants = [
            math.fsum(flat.probabilities[branch] for branch in flat.branches(node) if branch in branches)
            for node in range(len(flat))
        ]
        values = [0.0] * len(flat)
        self._solve(values, weights, constants, 0.0, self.endless)
        return min(1.0, max(0.0, values[0]))

    def mean(self, failure: float) -> float:
        """Return the expected cost of a run, where one that fails pays something on top of what it has spent.

        Args:
            failure: what it pays; may be infinite.
        """
        if failure not in self._means:
            flat = self.flat
            means = by_law(flat.laws, lambda law: law.mean)
            constants = [
                math.fsum(flat.probabilities[branch] * means[branch] for branch in flat.branches(node))
                for node in range(len(flat))
            ]
            values = self._end_values(failure)
            self._solve(values, flat.probabilities, constants, failure)
            self._means[failure] = values[0]
        return self._means[failure]

    def exponential_mean(self, slope: float, failure: float) -> float:
        """Return `ln E[e^(slope C)] / slope` of the cost C of a run; infinite where the expectation is.

        Args:
            slope: not 0, per unit of cost.
            failure: what a run that fails pays on top of what it has spent; may be infinite.
        """
        flat = self.flat
        means = by_law(flat.laws, lambda law: law.exponential_mean(slope))
        if abs(slope) * self.mean(failure) < NEARLY_NEUTRAL:
            near = self._nearly_neutral(slope, failure, means)
            if near is not None:
                return near
        weights = [math.log(p) + slope * mean for p, mean in zip(flat.probabilities, means, strict=True)]
        logs = [slope * value for value in self._end_values(failure)]
        for component in self.order:
            if flat.ends[component[0]] is not None:
                continue
            if not self.loops(component):
                node = component[0]
                logs[node] = log_sum([weights[b] + logs[flat.successors[b]] for b in flat.branches(node)])
                continue
            self._solve_logs(component, logs, weights, slope, failure)
        return logs[0] / slope + 0.0

    def _nearly_neutral(self, slope: float, failure: float, means: Sequence[float]) -> float | None:
        """Return the same where exponents are small, whose logarithms would lose digits; None where a loop is not.

        What is carried over is `N = E[(e^(slope C) - 1) / slope]`, nearly the mean.
        """
        flat = self.flat

        def grown(cost: float) -> float:
            return math.expm1(slope * cost) / slope

        weights = [p * math.exp(slope * mean) for p, mean in zip(flat.probabilities, means, strict=True)]
        constants = [
            math.fsum(flat.probabilities[branch] * grown(means[branch]) for branch in flat.branches(node))
            for node in range(len(flat))
        ]
        values = self._end_values(grown(failure))
        self._solve(values, weights, constants, grown(failure))
        return math.log1p(slope * values[0]) / slope if min(values) >= 0 and max(values) < math.inf else None

    def _end_values(self, failure: float) -> list[float]:
        return [failure if end in (End.FAILED, End.GIVEN_UP) else 0.0 for end in self.flat.ends]

    def _solve(
        self,
        values: list[float],
        weights: Sequence[float],
        constants: Sequence[float],
        failure: float,
        known: bytearray | None = None,
    ) -> None:
        """Solve `value = constant + sum of weight * value of the successor`; values of ends and known nodes are given.

        A loop without a way out is a failed run: its value is infinite where its constants are not 0.
        """
        flat = self.flat
        for component in self.order:
            if flat.ends[component[0]] is not None or (known is not None and known[component[0]]):
                continue
            if not self.loops(component):
                node = component[0]
                products = [weights[b] * values[flat.successors[b]] for b in flat.branches(node)]
                values[node] = math.fsum((constants[node], *products)) if math.inf not in products else math.inf
                continue
            if self.is_closed(component):
                is_free = not any(constants[node] for node in component)
                for node in component:
                    values[node] = failure if is_free else math.inf
                continue
            matrix, added = self._equations(component, values, weights, constants)
            if any(map(math.isinf, added)):
                solved = [math.inf] * len(component)
            else:
                solved = solution(matrix, added, len(component), self.is_large)
            for node, value in zip(component, solved, strict=True):
                values[node] = value

    def _solve_logs(
        self, component: Sequence[int], logs: list[float], weights: Sequence[float], slope: float, failure: float
    ) -> None:
        """Solve the equations of a component for logarithms, scaled by what leads out of it.

        For weights of a component that are not negative, a solution without negative numbers exists only if their
        spectral radius is below 1 (Perron and Frobenius): otherwise the expectation is infinite.
        """
        flat = self.flat
        inside = set(component)
        out = {
            node: [weights[b] + logs[other] for b in flat.branches(node) if (other := flat.successors[b]) not in inside]
            for node in component
        }
        scale = max((log for some in out.values() for log in some), default=-math.inf)
        is_closed = self.is_closed(component)
        if is_closed:
            is_free = all(flat.laws[b].most == 0 for node in component for b in flat.branches(node))
            scale = slope * failure if is_free else math.copysign(math.inf, slope)
        if is_closed or math.isinf(scale):
            for node in component:
                logs[node] = scale
            return
        shares = {node: math.fsum(math.exp(log - scale) for log in some) for node, some in out.items()}
        factors = {b: weights[b] for node in component for b in flat.branches(node) if flat.successors[b] in inside}
        solved = None
        if max(factors.values()) < math.log(1e300):
            row = {node: place for place, node in enumerate(component)}
            matrix = [
                (row[node], row[flat.successors[b]], math.exp(factors[b]))
                for node in component
                for b in flat.branches(node)
                if b in factors
            ]
            added = [shares[node] for node in component]
            solved = solution(matrix, added, len(component), self.is_large)
            is_none = not all(map(math.isfinite, solved)) or min(solved) < -ROUNDING * max(map(abs, solved))
            if is_none or (slope > 0 and not _is_positive_solution(matrix, added, solved)):
                solved = None
        for place, node in enumerate(component):
            if solved is None:
                logs[node] = math.inf
            else:
                logs[node] = scale + (math.log(solved[place]) if solved[place] > 0 else -math.inf)

    def _equations(
        self, component: Sequence[int], values: Sequence[float], weights: Sequence[float], constants: Sequence[float]
    ) -> tuple[list[tuple[int, int, float]], list[float]]:
        """Return the weights between a component's nodes, by row and column, and what the rest adds to each."""
        flat = self.flat
        row = {node: place for place, node in enumerate(component)}
        matrix: list[tuple[int, int, float]] = []
        added: list[float] = []
        for node in component:
            parts = [constants[node]]
            for branch in flat.branches(node):
                other = flat.successors[branch]
                if other in row:
                    matrix.append((row[node], row[other], weights[branch]))
                else:
                    parts.append(weights[branch] * values[other])
            added.append(math.inf if math.inf in parts else math.fsum(parts))
        return matrix, added


def _is_positive_solution(
    matrix: Sequence[tuple[int, int, float]], added: Sequence[float], solved: Sequence[float]
) -> bool:
    """Tell whether each number is positive and solves its own equation.

    Only then the spectral radius is at most 1 (Collatz and Wielandt). Beside numbers that are larger by many orders of
    magnitude, a negative one would look like a rounding error.
    """
    sums = list(added)
    for row, column, weight in matrix:
        sums[row] += weight * solved[column]
    return all(u > 0 and abs(u - right) <= RESIDUAL * u for u, right in zip(solved, sums, strict=True))
