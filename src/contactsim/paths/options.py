"""Options of a simulation: grid, tolerance, solver, increments, and what is kept."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from contactsim.contact.scene import Scene
from contactsim.elasticity.base import Elasticity
from contactsim.errors import InputError
from contactsim.paths.increments import Increments
from contactsim.provenance import digest
from contactsim.solvers.base import HardWallSolver
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.traits import Trait

ENDS = ("complete_contact",)
"""Events that end a path: every gap is closed. Beyond it a contact only overlaps more."""


@dataclass(frozen=True)
class Accuracy:
    """Relative error that a run is asked for.

    Parameters
    ----------
    error : float
        Relative error, above 0 and below 1.
    quantities : tuple of str
        Quantities whose error counts; those usual for the scene where empty.
    """

    error: float
    quantities: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not 0 < self.error < 1:
            raise InputError("accuracy", self.error, "a relative error above 0 and below 1, such as 0.01 for 1 %")


@dataclass(frozen=True)
class RunOptions:
    """Options of one simulation; None stands for the default of the scene.

    Parameters
    ----------
    points : int, optional
        Grid points along x; those of a measured surface by default.
    tolerance : float
        In grid steps at a hard wall, in parts of the strength with cohesive laws.
    solver : HardWallSolver or CohesiveSolver, optional
        The default solver of the scene where None.
    threads : int
        Threads of the transforms.
    accuracy : Accuracy, optional
        Relative error from which grid, tolerance and increments follow.
    keep : tuple of str, optional
        What to keep of a solution at a hard wall, of `observables.contact.KEPT`.
    increments : Increments, optional
        How a path of cohesive laws is followed; every increment as requested by default.
    snapshots : tuple of float, optional
        Values of the path near which histograms and fields are kept (cohesive laws).
    keep_fields : bool, optional
        False to keep histograms alone at the snapshots (cohesive laws).
    until : str, optional
        Event that ends a path, of `ENDS` (cohesive laws); the whole path where None.
    """

    points: int | None = None
    tolerance: float = 1e-3
    solver: HardWallSolver | CohesiveSolver | None = None
    threads: int = field(default=1, compare=False)
    accuracy: Accuracy | None = None
    keep: tuple[str, ...] | None = None
    increments: Increments | None = None
    snapshots: tuple[float, ...] | None = None
    keep_fields: bool | None = None
    until: str | None = None

    def __post_init__(self) -> None:
        if self.until not in (None, *ENDS):
            raise InputError("until", self.until, f"one of {', '.join(ENDS)}, or left out")


@dataclass(frozen=True)
class Setup:
    """A scene and the options of its simulation."""

    scene: Scene
    options: RunOptions = RunOptions()

    @property
    def points(self) -> int:
        """Grid points along x.

        Raises
        ------
        InputError
            Without a number of points, unless the surface comes with its own.
        """
        own = (body.surface.points for body in (self.scene.upper, self.scene.lower))
        points = self.options.points or next((count for count in own if count is not None), None)
        if points is None:
            raise InputError("points", None, "a whole number: only a measured surface comes with its own")
        return points

    @property
    def size(self) -> int:
        """All points of the grid."""
        return math.prod(self.scene.upper.surface.shape(self.points))

    def with_options(self, **changes: Any) -> Setup:
        """Return the same scene with some options changed."""
        return replace(self, options=replace(self.options, **changes))

    def with_increment(self, increment: float, pressing: float | None = None) -> Setup:
        """Return the same setup with its path in other increments; see `LoadPath.with_increment`."""
        path = self.scene.path.with_increment(increment, pressing)
        return replace(self, scene=replace(self.scene, path=path))

    @property
    def fingerprint(self) -> str:
        """Digest that two setups share if they have the same solution.

        It sees the scene as it acts: laws without a coupling that nothing excites, and bodies in which nothing moves
        along the surface by their contact modulus alone.
        """
        scene, options = self.scene, self.options
        bodies = [_acting_body(body, scene.components) for body in (scene.lower.elasticity, scene.upper.elasticity)]
        surfaces = scene.lower.surface, scene.upper.surface
        numbers = [
            digest(np.asarray(surface.heights(self.points)).tolist())
            for surface in surfaces
            if surface.points is not None
        ]
        parts = scene.acting, bodies, surfaces, scene.path, scene.pairing
        knobs = options.points, options.tolerance, options.solver, options.increments, options.until
        return digest([repr(part) for part in (*parts, *knobs)], numbers)


def _acting_body(body: Elasticity | None, components: tuple[str, ...]) -> Elasticity | float | None:
    """Return a body as it acts: a half-space in which nothing moves along the surface is its contact modulus."""
    if body is None or components != ("n",) or Trait.HALF_SPACE not in body.traits:
        return body
    return body.contact_modulus
