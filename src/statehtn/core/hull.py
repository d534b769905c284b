"""The best mean of some points by a convex function: what plans can be together that none of them is alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

STEPS = 200
HALVINGS = 60
CLOSE = 1e-12

Point = Sequence[float]


def best_mean(points: Sequence[Point], gradient: Callable[[Point], list[float]]) -> list[float]:
    """Return the weighted mean of points at which a convex function is the least, nearly.

    From the worst point that has a weight to the best one, by the gradient, weight is moved as far as the function
    falls: the pairwise variant of the algorithm of Frank and Wolfe (Lacoste-Julien and Jaggi, *On the global linear
    convergence of Frank-Wolfe optimization variants*, 2015).

    Args:
        points: one or more.
        gradient: of the function, up to a positive factor.
    """
    shares = [1.0, *([0.0] * (len(points) - 1))]
    mean = list(points[0])
    for _ in range(STEPS):
        slope = gradient(mean)
        heights = [_product(slope, point) for point in points]
        best = min(range(len(points)), key=heights.__getitem__)
        worst = max((index for index, share in enumerate(shares) if share > 0), key=heights.__getitem__)
        if heights[worst] - heights[best] <= CLOSE * abs(heights[worst]):
            break
        direction = [there - here for there, here in zip(points[best], points[worst], strict=True)]
        step = _step(mean, direction, shares[worst], gradient)
        shares[best] += step
        shares[worst] = 0.0 if step == shares[worst] else shares[worst] - step
        mean = [
            math.fsum(share * number for share, number in zip(shares, column, strict=True))
            for column in zip(*points, strict=True)
        ]
    return mean


def _step(start: Point, direction: Point, most: float, gradient: Callable[[Point], list[float]]) -> float:
    """Return how far to go in a direction: until the function rises."""

    def rises_at(step: float) -> bool:
        there = [number + step * change for number, change in zip(start, direction, strict=True)]
        return _product(gradient(there), direction) > 0

    if not rises_at(most):
        return most
    low, high = 0.0, most
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if rises_at(middle):
            high = middle
        else:
            low = middle
    return low


def _product(left: Point, right: Point) -> float:
    return math.fsum(one * other for one, other in zip(left, right, strict=True))
