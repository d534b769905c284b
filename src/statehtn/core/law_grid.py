"""The laws of what actions cost, on a grid of equally far costs: exact, or each rounded down."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.errors import UnsupportedError
from statehtn.limits import Limits, watched
from statehtn.model import CostDistribution, CostLaw
from statehtn.model.cost.scipy_call import scipy_call
from statehtn.model.cost.scipy_law import ScipyCost
from statehtn.model.cost.sum import parts_of
from statehtn.model.fraction import fraction_of

Outcomes = tuple[list[float], list[float]]
"""Of a law: whole steps, ascending, and the probability of each."""

EXACT_STEPS = 2**13
"""The grid is exact at once where the largest cost of an action has no more steps than this ..."""
FIRST_STEPS = 2**10
"""... and else so fine at first, each time `FINER` times finer, until it is exact, or has `MOST_STEPS`."""
FINER = 8
FEWEST_STEPS = 16
"""Of the largest cost, where the memory is too small for more."""
MOST_STEPS = 2**34
"""Sums of some thousand costs stay whole numbers in floating point."""
MOST_CELLS = 2**16
"""Of a continuous cost; it has no exact grid."""
TAIL = 2.0**-20
"""The probability at the upper end of an unbounded cost that is taken as the cost where it begins ..."""
SMALLER_TAIL = 2.0**-10
"""... and by which it is multiplied each time that the grid becomes finer."""
MEAN_BITS = 45
"""Of the largest mean as a price."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Equally far costs, and what is done where the laws of actions do not fit on them.

    A cost is rounded down to the next multiple of the step, of a continuous law all costs between two multiples to the
    lower one, and its upper end to where that begins. So each cost on the grid is at most the true one, together with
    it; hence no sum of independent costs has on the grid a value above its true one, by any monotone objective, nor a
    smaller probability to keep a budget. Whatever is proven on the grid to be a lower bound is one.

    Args:
        step: in the domain's unit.
        exact_step: the largest step of which all costs are multiples, as the fractions that they stand for; None where
            there is none, or none that is large enough.
        tail: the probability of the upper end.
        most_steps: that the largest cost may have.
    """

    step: Fraction
    exact_step: Fraction | None
    tail: float
    most_steps: int = MOST_STEPS

    @property
    def is_exact(self) -> bool:
        """Whether nothing is rounded."""
        return self.step == self.exact_step

    @staticmethod
    def first(laws: Iterable[CostLaw]) -> Grid:
        """Return a grid for laws: exact, or a coarse one."""
        parts = list(parts_of(laws))
        listed = [law for law in parts if isinstance(law, CostDistribution)]
        costs = {fraction_of(cost) for law in listed for _, cost in law.outcomes}
        tops = [_top(law, TAIL) for law in parts if not isinstance(law, CostDistribution)]
        largest = max([*map(float, costs), *tops], default=0.0) or 1.0
        common = _common_step(costs)
        if common is not None and largest > common * MOST_STEPS:
            common = None
        exact = common if len(listed) == len(parts) else None
        if exact is not None and largest <= exact * EXACT_STEPS:
            return Grid(exact, exact, TAIL)
        step = Fraction(2) ** math.floor(math.log2(largest / FIRST_STEPS))
        if common is not None:  # so that at least the lists of outcomes are exact at some time, or from the first
            step = common * math.floor(step / common) if step > common else common / math.ceil(common / step)
        return Grid(step, exact, TAIL, MOST_STEPS if len(listed) == len(parts) else MOST_CELLS)

    def finer(self, largest: float) -> Grid | None:
        """Return a finer grid; None where this one is exact, or as fine as can be."""
        if self.is_exact:
            return None
        step = self.step / FINER
        if self.exact_step is not None:
            step = max(self.exact_step, self.exact_step * math.floor(step / self.exact_step))
        elif largest > step * self.most_steps:
            return None
        return replace(self, step=step, tail=self.tail * SMALLER_TAIL)

    def coarser(self, largest: float) -> Grid | None:
        """Return a coarser grid, on which laws have fewer outcomes; None where hardly any would be left."""
        step = self.step * FINER
        return replace(self, step=step) if largest > step * FEWEST_STEPS else None

    def steps(self, cost: float) -> int:
        """Return the cost in whole steps, rounded down."""
        return math.floor(fraction_of(cost) / self.step)

    def outcomes(self, law: CostLaw) -> Outcomes:
        """Return a law on the grid."""
        first, *others = parts_of([law])
        if not others:
            return self._part(first)
        table = _relax.LawTable()
        total = table.add(*self._part(first))
        for part in others:
            total = table.sum(total, table.add(*self._part(part)))
        return table.outcomes(total)

    def _part(self, law: CostLaw) -> Outcomes:
        if isinstance(law, CostDistribution):
            return _merged((self.steps(cost), probability) for probability, cost in law.outcomes)
        if isinstance(law, ScipyCost):
            return self._cells(law)
        raise UnsupportedError(f"a cost of the kind {type(law).__name__} has no law on a grid")

    def _cells(self, law: ScipyCost) -> Outcomes:
        """Return a continuous law: what is in each cell stands at its lower end, the upper end where it begins."""
        import numpy

        first = self.steps(law.least)
        last = min(self.steps(_top(law, self.tail)), first + FINER * MOST_CELLS)  # a heavy tail would have any number
        ends = float(self.step) * numpy.arange(first + 1, last + 1)
        with scipy_call(law.title):
            below = law.frozen.cdf(numpy.nextafter(ends, -math.inf))  # a single cost at an end belongs to the next cell
        masses = numpy.maximum(numpy.diff(below, prepend=0.0, append=1.0), 0.0)
        return _merged(zip(range(first, last + 1), masses.tolist(), strict=True))


class LawGrid:
    """What a ground problem's actions cost, on a grid: laws, least costs and means.

    Args:
        grounding: the ground problem.
        grid: the grid.
        limits: they hold while laws are put on it.
        known: laws that are on this grid already; what others have in common with it.
    """

    def __init__(
        self, grounding: Grounding, grid: Grid, limits: Limits, known: dict[CostLaw, Outcomes] | None = None
    ) -> None:
        self.grounding = grounding
        self.grid = grid
        known = {} if known is None else known
        numbers: dict[CostLaw, int] = {}
        self._laws: list[Outcomes] = []

        def numbered(laws: Sequence[CostLaw]) -> list[int]:
            found = []
            for law in laws:
                number = numbers.get(law)
                if number is None:
                    limits.check()
                    number = numbers[law] = len(self._laws)
                    if law not in known:
                        known[law] = grid.outcomes(law)
                    self._laws.append(known[law])
                found.append(number)
            return found

        with watched(limits):
            self._actions, self._parts = numbered(grounding.laws), numbered(grounding.part_laws)
        self.costs = _relax.CostLaws(self._laws, self._actions, self._parts)

    @staticmethod
    def first(grounding: Grounding, limits: Limits) -> LawGrid:
        """Return the first grid for a ground problem."""
        return LawGrid(grounding, Grid.first({*grounding.laws, *grounding.part_laws}), limits)

    def finer(self, limits: Limits) -> LawGrid | None:
        """Return a finer one; None where there is none."""
        grid = self.grid.finer(self.largest)
        return None if grid is None else LawGrid(self.grounding, grid, limits)

    def coarser(self, limits: Limits) -> LawGrid | None:
        """Return a coarser one; None where there is none."""
        grid = self.grid.coarser(self.largest)
        return None if grid is None else LawGrid(self.grounding, grid, limits)

    @property
    def largest(self) -> float:
        """The largest cost of an action, in the domain's unit."""
        return max((at[-1] for at, _ in self._laws), default=0.0) * float(self.grid.step)

    def total(self, trace: _relax.SearchResult) -> CostLaw | None:
        """Return the law of a plan that was found; None where the grid is not exact."""
        if not self.grid.is_exact:
            return None
        table = _relax.LawTable()
        total = 0
        used = [*(self._actions[one] for one in trace.actions), *(self._parts[one] for one in trace.due_parts)]
        for number in used:
            total = table.sum(total, table.add(*self._laws[number]))
        at, probabilities = table.outcomes(total)
        costs = (float(self.grid.step * int(cost)) for cost in at)
        return CostDistribution.of(zip(probabilities, costs, strict=True))

    @cached_property
    def least(self) -> _relax.PricedProblem:
        """The problem at the least cost of everything, in steps."""
        return self._priced(lambda at, _: int(at[0]))

    @cached_property
    def units_per_step(self) -> float:
        """How many units of `means` a step has."""
        largest = max((at[-1] for at, _ in self._laws), default=1.0)
        return 2.0 ** (MEAN_BITS - math.frexp(largest)[1])

    @cached_property
    def means(self) -> _relax.PricedProblem:
        """The problem at the means of all laws on the grid, in units, rounded down."""
        scale = self.units_per_step

        def mean(at: list[float], probabilities: list[float]) -> int:
            exact = math.fsum(p * cost for cost, p in zip(at, probabilities, strict=True))
            return math.floor(exact * scale * (1 - (2.0**-48 if len(at) > 1 else 0.0)))

        return self._priced(mean)

    def _priced(self, price: Callable[[list[float], list[float]], int]) -> _relax.PricedProblem:
        prices = [price(*law) for law in self._laws]
        actions, parts = ([prices[number] for number in numbers] for numbers in (self._actions, self._parts))
        return _relax.PricedProblem(self.grounding.handle, actions, parts)


def _top(law: CostLaw, tail: float) -> float:
    return law.quantile(1 - tail) if math.isinf(law.most) else law.most


def _common_step(costs: Iterable[Fraction]) -> Fraction | None:
    """Return the largest number of which all are whole multiples; None where all are 0 or it cannot be a float."""
    positive = [cost for cost in costs if cost]
    if not positive:
        return Fraction(1)
    unit = math.lcm(*(cost.denominator for cost in positive))
    step = Fraction(math.gcd(*(int(cost * unit) for cost in positive)), unit)
    return step if float(step) > 0 else None


def _merged(outcomes: Iterable[tuple[int, float]]) -> Outcomes:
    """Return outcomes in order, equal ones as one, with probabilities that sum to 1."""
    found: dict[int, float] = {}
    for cost, probability in outcomes:
        if probability > 0:
            found[cost] = found.get(cost, 0.0) + probability
    total = math.fsum(found.values())
    at = sorted(found)
    return [float(cost) for cost in at], [found[cost] / total for cost in at]
