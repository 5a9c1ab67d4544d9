"""The kinds of problem that a scene poses."""

from __future__ import annotations

from enum import Enum


class ProblemKind(Enum):
    """One of the two kinds of problem that a scene poses.

    They differ in their unknowns, solvers, paths and observables. `Scene.kind` is the one place that tells them apart;
    all else looks up what it needs by kind.
    """

    HARD_WALL = "hard_wall"
    """Gap and pressure are never negative, and one of them is zero at each point; each load has one solution."""
    COHESIVE = "cohesive"
    """Traction is a smooth function of the gap; states follow one another along a path."""
