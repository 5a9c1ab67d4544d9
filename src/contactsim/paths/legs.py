"""Legs of a path: parts under one control and in one direction, with the states that were solved on them."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from contactsim.contact.steps import LoadStep
from contactsim.paths.jumps import Jump
from contactsim.paths.segments import Segment
from contactsim.solvers.cohesive.base import Equilibrium
from contactsim.status import Status


@dataclass
class Leg:
    """A part of a path under one control and in one direction, and the segments of states that were solved on it."""

    steps: Sequence[LoadStep]
    segments: list[Segment] = field(default_factory=lambda: [Segment()])
    iterations: int = 0
    status: Status = Status.CONVERGED
    unlocated: float | None = None  # first parameter on the way to which jumps were not located

    @property
    def direction(self) -> int:
        """Sign of the change of the parameter along the leg."""
        parameters = self.segments[0].parameters
        start = parameters[0] if parameters else self.steps[0].value
        return 1 if self.steps[-1].value >= start else -1

    @cached_property
    def _places(self) -> list[float]:
        """Values of the requested steps in the direction of the leg, in rising order."""
        return sorted(self.direction * step.value for step in self.steps)

    def add(self, parameter: float, state: Equilibrium, jumps: tuple[Jump, ...]) -> None:
        """Append a solved state; jumps on the way to it begin a new segment."""
        if jumps:
            self.segments.append(Segment(jumps))
        self.segments[-1].add(parameter, state)

    def passed_segments(self, value: float) -> list[Segment]:
        """Return the segments that begin before a parameter, or at it."""
        return [
            segment
            for segment in self.segments
            if segment.parameters and self.direction * (value - segment.parameters[0]) >= 0
        ]

    def jumps_before(self, value: float) -> tuple[Jump, ...]:
        """Return the jumps between the requested state at a parameter and the one requested before it."""
        direction = self.direction
        earlier = bisect_left(self._places, direction * value)
        previous = self._places[earlier - 1] if earlier else -np.inf
        new = [item for item in self.passed_segments(value) if direction * item.parameters[0] > previous]
        return tuple(jump for segment in new for jump in segment.jumps)


def leg_end(steps: Sequence[LoadStep], begin: int, parameter: float | None) -> int:
    """Return the end (exclusive) of the leg that begins at a step: one control, one direction; a hold is a leg too.

    `parameter` is that of the current state, None at the beginning of the path.
    """
    before, direction = parameter, None
    for index in range(begin, len(steps)):
        if steps[index].control is not steps[begin].control:
            return index
        change = None if before is None else float(np.sign(steps[index].value - before))
        if direction is not None and change != direction:
            return index
        before, direction = steps[index].value, change
    return len(steps)
