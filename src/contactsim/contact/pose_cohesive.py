"""From a scene of smooth laws to the problem at zero approach."""

from __future__ import annotations

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.scene import Scene
from contactsim.elasticity.base import relative_compliance, relative_coupled_compliance
from contactsim.elasticity.free_operator import padded_compliance
from contactsim.elasticity.symbol import NormalSymbol, Symbol
from contactsim.errors import InputError, is_number
from contactsim.grid import Array, Grid, TransformCounter
from contactsim.interface.base import Law
from contactsim.interface.superposition import superpose
from contactsim.interface.wall_pressure import WallPressure
from contactsim.traits import Trait

MIN_TOLERANCE, MAX_TOLERANCE = 1e-13, 0.1
"""Smallest tolerance, which rounding hides, and the largest: with a larger one, the undeformed state would soon be a
solution."""


CONTACT_GAP = 1e-3
"""Gap, over the laws' length, at which a law's tangent is that of contact with a wall."""
FAR = 1e6
"""Gap beyond the ends of heights that do not repeat, in the longest length of a law: no law reaches so far."""


def check_tolerance(tolerance: float, name: str = "tolerance") -> None:
    """Refuse a tolerance that rounding hides, or that the undeformed state would meet."""
    if not (is_number(tolerance) and MIN_TOLERANCE <= tolerance <= MAX_TOLERANCE):
        allowed = f"at least {MIN_TOLERANCE:g}, at most {MAX_TOLERANCE:g}, in parts of the laws' strength"
        raise InputError(name, tolerance, allowed)


def pose_cohesive(scene: Scene, heights: Array, tolerance: float, threads: int = 1) -> CohesiveProblem:
    """Return the problem of a scene of smooth laws at zero approach.

    Parameters
    ----------
    scene
        Scene of laws, with or without a hard wall beside them.
    heights
        Sum of both surfaces' heights (n,) or (ny, nx), nm.
    tolerance
        Largest residual at any point, over the strength of the laws.
    threads
        Threads of a transform.

    Raises
    ------
    InputError
        If the tolerance or the grid is not allowed.
    """
    check_tolerance(tolerance)
    lower = scene.lower.surface.heights(heights.shape[-1])
    law = scene.pairing.join(superpose(scene.acting_laws), lower, scene.length)
    own = Grid(heights.shape, scene.lengths, threads)
    grid, stiffness, slip_factor = _stiffness(scene, own)
    undeformed = np.full(grid.shape, FAR * _reach(scene) - heights.min())
    undeformed[tuple(slice(0, size) for size in own.shape)] = -heights
    shape = np.zeros((len(scene.components), grid.size))
    shape[0] = undeformed.ravel()
    has_wall = Trait.ADHESIVE_WALL in scene.traits
    return CohesiveProblem(
        grid=grid,
        shape=shape,
        law=law,
        pairing=scene.pairing,
        stiffness=stiffness,
        slip_factor=slip_factor,
        tolerance=tolerance,
        counter=TransformCounter(grid.size),
        origin=scene.path.origin(heights),
        heights_grid=None if scene.repeats else own,
        wall=WallPressure.zero(grid.size, stiffness.diagonal[0], _stiffness_in_contact(law)) if has_wall else None,
    )


def _stiffness_in_contact(law: Law) -> float:
    """Return the size of a law's tangent where gaps begin to open, GPa/nm."""
    return float(np.abs(law.tangent(np.full((1, 1), CONTACT_GAP * law.interaction_range))[1]).max())


def _reach(scene: Scene) -> float:
    """Return the longest length of a law, nm."""
    return max(float(getattr(law, "normal_length", law.interaction_range)) for law in scene.acting_laws)


def _stiffness(scene: Scene, grid: Grid) -> tuple[Grid, Symbol, Array | None]:
    """Return the grid, K of the exerted components, and the slip factor where the tangential gap is only read.

    grid: of the heights, which is the grid where they repeat
    """
    lower, upper = scene.lower.elasticity, scene.upper.elasticity
    if not scene.repeats:
        padded, compliance_of_unit = padded_compliance(grid)
        return padded, NormalSymbol(compliance_of_unit[None] / scene.contact_modulus).flattened().inverse(), None
    if len(scene.exerted) == len(scene.components):
        return grid, relative_compliance(lower, upper, grid, scene.components).flattened().inverse(), None
    compliance = relative_coupled_compliance(lower, upper, grid)
    return grid, compliance.without_shear().inverse(), compliance.slip()
