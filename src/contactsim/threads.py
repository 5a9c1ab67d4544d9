"""Threads of dense algebra."""

from __future__ import annotations

from threadpoolctl import threadpool_limits


def limit_threads(threads: int) -> threadpool_limits:
    """Return a context in which dense algebra has at most that many threads.

    On small systems more would only wait for each other, and change the last digits of a result. The library is loaded
    here, as one that is loaded later would have as many threads as there are cores.
    """
    import scipy.linalg  # noqa: F401 — takes longer to import than the rest of a solver

    return threadpool_limits(threads, "blas")
