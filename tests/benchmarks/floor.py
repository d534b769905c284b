"""The least time that an evaluation can take if it reads its relaxed model once from memory."""

from __future__ import annotations

import time

import numpy as np

READ_BYTES = 1 << 28  # more than caches hold
REPEAT = 5


def read_bandwidth() -> float:
    """Return how many bytes one core reads from memory in a second, one after the other: the best of some trials."""
    numbers = np.ones(READ_BYTES // 8, dtype=np.int64)
    seconds = []
    for _ in range(REPEAT):
        start = time.perf_counter()
        numbers.sum()
        seconds.append(time.perf_counter() - start)
    return READ_BYTES / min(seconds)
