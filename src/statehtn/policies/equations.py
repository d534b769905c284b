"""Linear equations, and sums as logarithms."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING

from statehtn.errors import UsageError

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

    Vector = NDArray[float64]

MOST_DENSE = 400
"""Equations: more are solved as sparse ones."""
FEW = 100
"""Equations: more are solved as sparse ones where there are many systems of them, and scipy is installed."""
MUCH = 2_000_000_000
"""Of the cubes of the numbers of equations: dense systems take longer together than to import scipy."""


def solution(
    matrix: Sequence[tuple[int, int, float]], added: Sequence[float], count: int, is_one_of_many: bool = False
) -> list[float]:
    """Return x of `x = M x + b`; infinite numbers where there is no single one.

    Args:
        matrix: row, column and weight.
        added: b.
        count: the number of equations.
        is_one_of_many: whether so many such systems are solved that dense ones take long.

    Raises:
        UsageError: there are many equations, and scipy is not installed.
    """
    import numpy

    def dense_solution() -> list[float]:
        dense = numpy.eye(count)
        for i, j, weight in matrix:
            dense[i, j] -= weight
        try:
            found: Vector = numpy.linalg.solve(dense, numpy.array(added))
        except numpy.linalg.LinAlgError:
            return [math.inf] * count
        return [float(value) for value in found]

    if count <= (FEW if is_one_of_many else MOST_DENSE):
        return dense_solution()
    try:
        from scipy.sparse import csr_matrix, identity
        from scipy.sparse.linalg import MatrixRankWarning, spsolve
    except ImportError:
        if count <= MOST_DENSE:
            return dense_solution()
        raise UsageError(
            f"the value of a policy that loops through {count} states needs the package 'scipy': "
            "pip install 'statehtn[scipy]'"
        ) from None
    rows, columns, weights = zip(*matrix, strict=True)
    sparse = identity(count, format="csr") - csr_matrix((weights, (rows, columns)), shape=(count, count))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MatrixRankWarning)
        found = spsolve(sparse.tocsc(), numpy.array(added))
    return [float(value) for value in found] if numpy.isfinite(found).all() else [math.inf] * count


def log_sum(logs: Sequence[float]) -> float:
    """Return the logarithm of the sum of `e^x`."""
    largest = max(logs)
    if math.isinf(largest):
        return largest
    return largest + math.log(math.fsum(math.exp(log - largest) for log in logs))
