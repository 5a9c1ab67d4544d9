"""Threads: how many dense algebra may take, and loops that several of them share."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait
from functools import cache
from typing import TypeVar

from threadpoolctl import threadpool_limits

T = TypeVar("T")


def limit_threads(threads: int) -> threadpool_limits:
    """Return a context in which dense algebra has at most that many threads.

    On small systems more would only wait for each other, and change the last digits of a result. The library is loaded
    here, as one that is loaded later would have as many threads as there are cores.
    """
    import scipy.linalg  # noqa: F401 — takes longer to import than the rest of a solver

    return threadpool_limits(threads, "blas")


def share_work(work: Callable[[int], T], count: int, threads: int) -> list[T]:
    """Return the results of a function of 0 to count - 1, computed by several threads, of which this is one.

    The function must not share work itself: it would wait for threads that wait for it.
    """
    shares, results = max(min(threads, count), 1), {}

    def take(first: int) -> None:
        """Do the share of one thread."""
        for number in range(first, count, shares):
            results[number] = work(number)

    submit = _pool(threads - 1, os.getpid()).submit if shares > 1 else None
    others = [submit(take, first) for first in range(1, shares)] if submit else []
    try:
        take(0)
    finally:
        wait(others)  # nothing is written any more when this returns or raises
    for other in others:
        other.result()
    return [results[number] for number in range(count)]


@cache
def _pool(threads: int, process: int) -> ThreadPoolExecutor:
    """Return so many threads of a process; they are kept, as starting one takes longer than a loop may."""
    return ThreadPoolExecutor(threads)
