"""How far a workflow has come, and the time left, from the predicted and the measured time of its jobs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field

UNKNOWN_SECONDS = 30.0
"""Seconds expected of a job without prediction, until one of its rule has ended."""
PRIOR_SECONDS = 5.0
"""Seconds of predicted work that count as if they had been measured to be right."""


@dataclass(frozen=True)
class Job:
    """A job: its number, its rule, what it says of itself, and the CPU seconds predicted for it, if any."""

    number: int
    rule: str
    label: str = ""
    predicted: float | None = None


@dataclass
class Progress:
    """Jobs waiting, running and done; cores: jobs that run at once."""

    cores: int = 1
    waiting: dict[int, Job] = field(default_factory=dict)
    running: dict[int, tuple[Job, float]] = field(default_factory=dict)
    done: list[tuple[Job, float]] = field(default_factory=list)
    failed: list[Job] = field(default_factory=list)

    @property
    def total(self) -> int:
        """Number of jobs."""
        return len(self.waiting) + len(self.running) + len(self.done) + len(self.failed)

    def start(self, job: Job, now: float) -> None:
        """Note that a job has started; one that was not known before is added."""
        self.waiting.pop(job.number, None)
        self.running[job.number] = job, now

    def finish(self, number: int, now: float) -> Job | None:
        """Note that a job has ended; return it."""
        if number not in self.running:
            return None
        job, start = self.running.pop(number)
        self.done.append((job, now - start))
        return job

    def fail(self, number: int) -> None:
        """Note that a job has failed."""
        if number in self.running:
            self.failed.append(self.running.pop(number)[0])

    def share(self, now: float) -> float:
        """Return the share of the expected time of all jobs that is over."""
        expected = self._expectation()
        over = sum(expected(job) for job, _ in self.done) + sum(expected(job) for job in self.failed)
        over += sum(min(now - start, expected(job)) for job, start in self.running.values())
        jobs = [*self.waiting.values(), *self.failed, *(job for job, _ in [*self.done, *self.running.values()])]
        whole = sum(map(expected, jobs))
        return over / whole if whole > 0 else 0.0

    def seconds_left(self, now: float) -> float:
        """Return the seconds until the last job ends, if jobs take as much longer as those that have ended."""
        expected = self._expectation()
        rest = [max(expected(job) - (now - start), 0.0) for job, start in self.running.values()]
        work = sum(rest) + sum(map(expected, self.waiting.values()))
        return max([work / self.cores, *rest, *map(expected, self.waiting.values())], default=0.0)

    def _expectation(self) -> Callable[[Job], float]:
        """Return a function for the seconds expected of a job."""
        predicted = sum(job.predicted for job, _ in self.done if job.predicted is not None)
        measured = sum(seconds for job, seconds in self.done if job.predicted is not None)
        factor = (measured + PRIOR_SECONDS) / (predicted + PRIOR_SECONDS)
        times: defaultdict[str, list[float]] = defaultdict(list)
        for job, seconds in self.done:
            if job.predicted is None:
                times[job.rule].append(seconds)
        means = {rule: sum(seconds) / len(seconds) for rule, seconds in times.items()}

        def expected(job: Job) -> float:
            """Return the seconds of a job: predicted and corrected, or those of others of its rule."""
            return means.get(job.rule, UNKNOWN_SECONDS) if job.predicted is None else factor * job.predicted

        return expected
