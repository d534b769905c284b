"""The sweep of the attitude map: the best plan of every exponential agent of an interval of alpha, to a given loss.

One session makes many runs of A*, each for one alpha. Every plan that is found is a candidate for all other alphas,
since its certainty equivalent is known there exactly. Between two alphas that were searched, bounds say how far from
optimal the best known plan may be (`statehtn.sweeps.segments`). The segment where that is most is dealt with next:

- If different plans are best at its ends, it is split on both sides of the point where their certainty equivalents
  cross, until the break between them is as narrow as was asked for, or a third plan is found there.
- If one plan is best at both ends, and lines that touch at one point could prove it good enough in between, two runs
  try that. Otherwise, and where they fail, it is split at half of what the plan gains on it.

In the end all plans are enumerated that may be best somewhere, where these are few. A plan with a certainty equivalent
above `V(b)` at a slope `a` is not best anywhere between `a` and `b`: its certainty equivalent rises with the slope, and
V is nowhere above `V(b)` there. So the plans up to `V(b)`, a top-k search at `a`, are enough; where there are no more
than that, nothing is left to prove, and a break between two of them is where their curves cross.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

from statehtn.found_plan import FoundPlan
from statehtn.limits import ENDINGS, status_of
from statehtn.model.status import Status
from statehtn.result import Result
from statehtn.sweeps.plan_curve import PlanCurve, bisected
from statehtn.sweeps.prices import Minorant, prices_at
from statehtn.sweeps.runs import Runs
from statehtn.sweeps.segments import Point, Segment, inverse

PART_OF_RANGE = 1e-3
"""Of what V gains on the interval: the loss that is allowed by default."""
LEAST_LOSS = 2.0**-27
"""Of V: less cannot be proven, since a run is optimal to 2^-30 of the cost."""
TIE = 1e-12
SHARE = 0.9  # of the loss that is allowed, which lines may lose on the best plan known; the rest is for others
LEAST_PART = 2.0**-10  # of a segment, that it is split off
FINEST = 1e-9
"""Of alpha: the width of a segment that is not split any more, however much is left to prove."""
MOST_PLANS = 64
FEWER_PLANS = 12
"""So many plans are enumerated for the whole interval, and for a part of it; beyond that the gap stays as it is."""
PIECES = 8  # of a segment on which all plans are known, in which their curves are compared
CENTRE = 1e-3  # next to neutral, break points are as precise as at this distance


@dataclass(frozen=True, slots=True)
class Known:
    """A plan that was found, and what it is worth to everyone."""

    found: FoundPlan
    curve: PlanCurve


@dataclass(frozen=True, slots=True)
class Stretch:
    """Slopes on which one plan is the best one known, and how far from optimal it may be there."""

    low: float
    high: float
    plan: Known
    gap: float


class AlphaSweep:
    """Finds plans for all slopes of an interval.

    Args:
        runs: that make the searches.
        low: the lowest slope: alpha of an averse agent, -alpha of a seeking one; may be infinite.
        high: the highest, above it.
        loss: how far from optimal plans may be, in the domain's unit; None: `PART_OF_RANGE`.
        resolution: how narrow the interval of a break point shall be, as a part of the alpha.
    """

    def __init__(self, runs: Runs, low: float, high: float, loss: float | None, resolution: float) -> None:
        self.runs = runs
        self.slopes = [low, *([0.0] if low < 0 < high else []), high]
        self.loss = loss
        self.resolution = resolution
        self.known: list[Known] = []
        self.done: list[Segment] = []
        self.todo: list[tuple[float, int, Segment]] = []
        self.numbers = itertools.count()
        self.unit = 1.0  # of 1/slope: what a plan costs
        self.status = Status.UNSOLVABLE

    def sweep(self) -> None:
        """Search until every plan is proven to be good enough, or a limit is reached."""
        try:
            self.begin()
            while self.todo and self.runs.stopped is None:
                parts = list(self.refined(self.todo[0][-1]))
                heapq.heappop(self.todo)
                for part in parts:
                    self.push(part)
            self.complete(self.segments)
        except ENDINGS as ending:  # between two runs
            self.runs.stopped = status_of(ending)
            if not self.known:
                self.status = self.runs.stopped
            elif not self.segments:
                self.begin()  # which searches no more

    def begin(self) -> None:
        """Search at the ends, and for the neutral agent between them."""
        points: list[Point] = []
        for slope in self.slopes:
            points.append(self.searched(slope, points[-1].bound if points else 0.0))
            if not self.known:
                return
        first, last = points[0], points[-1]
        self.unit = max(self.best_at(self.slopes[0]).curve.at(0.0), 1e-300)
        gain = self.best_at(last.slope).curve.at(last.slope) - first.bound
        least = LEAST_LOSS * self.best_at(last.slope).curve.at(last.slope)
        self.loss = max(PART_OF_RANGE * gain, least) if self.loss is None else self.loss
        for low, high in itertools.pairwise(points):
            self.push(Segment(low, high))

    def refined(self, segment: Segment) -> Iterator[Segment]:
        """Prove more of a segment, or yield its parts."""
        assert self.loss is not None
        left, right = (known.curve for known in self.best_on(segment))
        if left != right:
            yield from self.split(segment, self.beside_the_break(segment, left, right))
            return
        if segment.is_averse and segment.chord is None:
            at, remaining = segment.touching(left)
            if remaining <= SHARE * self.loss:
                self.add_chord(segment, at)
                if self.runs.stopped is not None or segment.gap(left) <= self.loss:
                    yield segment
                    return
        yield from self.split(segment, [self.halfway(segment, left)])

    def add_chord(self, segment: Segment, at: float) -> None:
        """Bound all plans on a segment by two runs at the prices of lines that touch at some x."""
        low, high = segment.ends
        ends: list[float] = []
        for upper in (True, False):
            result = self.taken(self.runs.run(Minorant(low, high, at, upper)))
            if result.lower_bound is None or self.runs.stopped is not None:
                return
            ends.append(result.lower_bound)
        segment.chord = ends[0], ends[1]

    def split(self, segment: Segment, slopes: list[float]) -> Iterator[Segment]:
        """Search at some slopes of a segment, in order; yield its parts."""
        low = segment.low
        for slope in slopes:
            if self.runs.stopped is not None:
                break
            point = self.searched(slope, low.bound)
            yield Segment(low, point)
            low = point
        yield Segment(low, segment.high)

    def complete(self, segments: list[Segment], most: int = MOST_PLANS) -> None:
        """Enumerate the plans that may be best on adjacent segments, or on one half of them after the other."""
        if not segments or self.runs.stopped is not None:
            return
        low, high = segments[0].low.slope, segments[-1].high.slope
        top = self.runs.top(prices_at(low), most, "sequence" if self.runs.order_matters else "multiset")
        for plan in top.plans:
            self.take(plan)
        worst = self.best_at(high).curve.at(high)
        is_complete = top.is_all or (top.lower_bound is not None and top.lower_bound > worst * (1 + TIE))
        if self.runs.stopped is None and is_complete:
            for segment in segments:
                segment.is_complete = True
        elif len(segments) > 1:
            middle = len(segments) // 2
            self.complete(segments[:middle], FEWER_PLANS)
            self.complete(segments[middle:], FEWER_PLANS)

    def searched(self, slope: float, proven: float) -> Point:
        """Search for the plan of one agent; `proven` is known of V there already."""
        bound = None
        if self.runs.stopped is None:
            bound = self.taken(self.runs.run(prices_at(slope))).lower_bound
        return Point(slope, proven if bound is None else max(bound, proven))

    def taken(self, result: Result) -> Result:
        """Take up the plan of a run."""
        if result.found is None:
            self.status = result.status
            return result
        self.take(result.found)
        return result

    def take(self, found: FoundPlan) -> None:
        """Take up a plan, unless it is worth the same to everyone as another one."""
        curve = PlanCurve(step.law for step in found.steps)
        if all(curve != known.curve for known in self.known):
            self.known.append(Known(found, curve))

    def best_at(self, slope: float) -> Known:
        """Return the best known plan at a slope; of equally good ones the first."""
        return min(self.known, key=lambda known: known.curve.at(slope))

    def best_on(self, segment: Segment) -> tuple[Known, Known]:
        """Return the best known plans at both ends of a segment; one plan, where it is as good as any at both."""
        return self.best_between(segment.low.slope, segment.high.slope)

    def best_between(self, low: float, high: float) -> tuple[Known, Known]:
        """Return the best known plans at two slopes; one plan, where it is as good as any at both."""
        left, right = self.best_at(low), self.best_at(high)
        if right.curve.at(low) <= left.curve.at(low) * (1 + TIE):
            return right, right
        if left.curve.at(high) <= right.curve.at(high) * (1 + TIE):
            return left, left
        return left, right

    def push(self, segment: Segment) -> None:
        """Put a segment where it belongs: it is done, or it is not."""
        assert self.loss is not None
        parts = list(self.parts(segment))
        gap = max(part.gap for part in parts)
        is_good = gap <= self.loss and (len(parts) == 1 or self.is_narrow(segment, self.resolution))
        if is_good or self.is_narrow(segment, FINEST):
            self.done.append(segment)
        else:
            heapq.heappush(self.todo, (-gap, next(self.numbers), segment))

    @property
    def segments(self) -> list[Segment]:
        """The whole interval in order."""
        return sorted([*self.done, *(segment for _, _, segment in self.todo)], key=lambda one: one.low.slope)

    def stretches(self) -> Iterator[Stretch]:
        """Yield the whole interval in order, each part with the best plan known there and how good it is."""
        for segment in self.segments:
            yield from self.parts(segment)

    def parts(self, segment: Segment) -> Iterator[Stretch]:
        """Yield the parts of a segment on which one plan is the best one known: one, or two; more if all are known."""
        low, high = segment.low.slope, segment.high.slope
        if segment.is_complete:
            start, end = self.place(low), self.place(high)
            inner = (self.slope(start + (end - start) * part / PIECES) for part in range(1, PIECES))
            for left_end, right_end in itertools.pairwise((low, *inner, high)):
                yield from self.lowest(left_end, right_end)
            return
        left, right = self.best_on(segment)
        if left is right:
            yield Stretch(low, high, left, segment.gap(left.curve))
            return
        at = self.crossing(low, high, left.curve, right.curve)
        middle = Point(at, segment.low.bound)
        yield Stretch(low, at, left, Segment(segment.low, middle).gap(left.curve))
        yield Stretch(at, high, right, Segment(middle, segment.high).gap(right.curve))

    def lowest(self, low: float, high: float) -> Iterator[Stretch]:
        """Yield the parts between two slopes on which one plan is the best of all, which are known."""
        left, right = self.best_between(low, high)
        if left is right:
            yield Stretch(low, high, left, 0.0)
            return
        at = self.crossing(low, high, left.curve, right.curve)
        third = self.best_at(at)
        if low < at < high and third.curve.at(at) < min(left.curve.at(at), right.curve.at(at)) * (1 - TIE):
            yield from self.lowest(low, at)
            yield from self.lowest(at, high)
            return
        yield Stretch(low, at, left, 0.0)
        yield Stretch(at, high, right, 0.0)

    def beside_the_break(self, segment: Segment, left: PlanCurve, right: PlanCurve) -> list[float]:
        """Return slopes on both sides of the crossing of two plans, as close as a break point shall be known."""
        at = self.place(self.crossing(segment.low.slope, segment.high.slope, left, right))
        apart = 0.4 * self.resolution * _spread(at)
        return [
            slope
            for place in (at - apart, at + apart)
            if segment.low.slope < (slope := self.slope(place)) < segment.high.slope
        ] or [self.slope((self.place(segment.low.slope) + self.place(segment.high.slope)) / 2)]

    def crossing(self, low: float, high: float, left: PlanCurve, right: PlanCurve) -> float:
        """Return the slope from which on the second plan is better, where the first one is better below."""

        def is_beyond(place: float) -> bool:
            slope = self.slope(place)
            return right.at(slope) < left.at(slope)

        slope = self.slope(bisected(is_beyond, self.place(low), self.place(high)))
        return 0.0 if abs(slope) * self.unit < TIE else slope  # plans of equal means cross there

    def halfway(self, segment: Segment, plan: PlanCurve) -> float:
        """Return the slope at which a plan has half of what it gains on a segment.

        Next to neutral nothing is known but that V rises: there it is the slope up to which that suffices.
        """
        assert self.loss is not None
        low, high = segment.low.slope, segment.high.slope
        least, most = plan.at(low), plan.at(high)
        if low == 0:
            half = least + min(SHARE * self.loss, (most - least) / 2)
        else:
            half = most - (min(SHARE * self.loss, (most - least) / 2) if high == 0 else (most - least) / 2)
        start, end = self.place(low), self.place(high)
        place = bisected(lambda at: plan.at(self.slope(at)) >= half, start, end, precision=1e-6)
        margin = (end - start) * LEAST_PART
        return self.slope(min(max(place, start + margin), end - margin))

    def is_narrow(self, segment: Segment, part: float) -> bool:
        """Tell whether a segment is no wider than a part of its alpha."""
        low, high = self.place(segment.low.slope), self.place(segment.high.slope)
        return high - low <= part * max(_spread(low), _spread(high))

    def place(self, slope: float) -> float:
        """Return where a slope stands between -1, infinitely seeking, and 1, infinitely averse."""
        return math.copysign(1 / (1 + inverse(slope) / self.unit), slope) if slope else 0.0

    def slope(self, place: float) -> float:
        """Return the slope that stands at a place."""
        size = abs(place)
        if size >= 1:
            return math.copysign(math.inf, place)
        return math.copysign(size / (1 - size) / self.unit, place)


def _spread(place: float) -> float:
    """Return how far apart places are for a given part of alpha; also near the ends and the centre not nothing."""
    return max(abs(place) * (1 - abs(place)), CENTRE)
