"""Runs of a policy drawn at random, many at a time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from statehtn.model.policy_graph import End
from statehtn.policies.chain import Chain

if TYPE_CHECKING:
    from numpy import bool_, float64
    from numpy.random import Generator
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, repr=False, eq=False)
class SimulatedRuns:
    """Runs of a policy that were drawn at random.

    Args:
        costs: what each has cost, in the domain's unit: one that failed what it had spent, and the failure cost.
        done: whether each is done; the others have failed.
    """

    costs: NDArray[float64]
    done: NDArray[bool_]

    def __len__(self) -> int:
        return len(self.costs)

    def __repr__(self) -> str:
        return f"<{len(self)} runs: mean {self.mean:.6g}, done {self.success_rate:.6g}>"

    @property
    def mean(self) -> float:
        """The mean cost."""
        return float(self.costs.mean())

    @property
    def standard_error(self) -> float:
        """The standard deviation of the mean cost over such samples; infinite for one run."""
        import numpy

        return float(self.costs.std(ddof=1) / numpy.sqrt(len(self))) if len(self) > 1 else float("inf")

    @property
    def success_rate(self) -> float:
        """The share of runs that are done."""
        return float(self.done.mean())


def simulate(chain: Chain, runs: int, generator: Generator, failure: float) -> SimulatedRuns:
    """Draw runs of a policy.

    All runs take a step at a time together. A run in a loop without a way out has failed.

    Args:
        chain: the policy.
        runs: how many.
        generator: of numpy.
        failure: what a run pays that fails, on top of what it has spent; may be infinite.
    """
    import numpy

    flat = chain.flat
    first = numpy.array(flat.first)
    summed = numpy.concatenate(([0.0], numpy.cumsum(numpy.array(flat.probabilities, dtype=float))))
    successors = numpy.array(flat.successors, dtype=int)
    numbers = {id(law): number for number, law in enumerate({id(law): law for law in flat.laws}.values())}
    law_of = numpy.array([numbers[id(law)] for law in flat.laws], dtype=int)
    laws = list({id(law): law for law in flat.laws}.values())
    is_over = numpy.array([end is not None or bool(chain.endless[node]) for node, end in enumerate(flat.ends)])
    is_done = numpy.array([end is End.DONE for end in flat.ends])
    nodes, costs = numpy.zeros(runs, dtype=int), numpy.zeros(runs)
    active = numpy.arange(runs) if not is_over[0] else numpy.arange(0)
    while len(active):
        at = nodes[active]
        low, high = summed[first[at]], summed[first[at + 1]]
        wanted = low + generator.random(len(active)) * (high - low)
        taken = numpy.clip(numpy.searchsorted(summed, wanted, side="right") - 1, first[at], first[at + 1] - 1)
        kinds = law_of[taken]
        for kind in numpy.unique(kinds):
            some = active[kinds == kind]
            costs[some] += laws[kind].sample(len(some), generator)
        nodes[active] = successors[taken]
        active = active[~is_over[nodes[active]]]
    done = is_done[nodes]
    costs[~done] += failure
    return SimulatedRuns(costs, done)


def sampled_costs(chain: Chain, runs: int, generator: Generator, failure: float) -> NDArray[float64]:
    """Draw the costs of so many runs."""
    return simulate(chain, runs, generator, failure).costs
