"""Partial slip: a contact that is pressed, and then sheared, under Coulomb's law of friction.

Where the bodies are alike, the tangential traction is a difference of two pressures: that of the load P, and that of a
smaller one at which the contact is the stick area,

    q = μ (p(P) - p(P - Q/μ)).

Within the stick area both states differ by a rigid approach, so q shifts it as a whole, and around it q is μp. This is
exact on lines, and on surfaces where Poisson's ratio is zero. Elsewhere the tractions do not shift all points of the
stick area alike, and slip is not everywhere against the traction. Two numbers tell by how much.

Only the smaller pressure is solved for. It presses the surface as p(P) displaces it, not the heights, so the difference
carries neither the error of p(P) nor the rounding of the heights. Coulomb's law and the total are then recomputed from
q: the largest error is the residual.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from contactsim.arguments import Positive, checked
from contactsim.contact.hard_wall import HardWallProblem, Profile, Scale
from contactsim.contact.loading import LoadPath, load_step
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Scene
from contactsim.elasticity.base import PoissonRatio
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.shear import shear_displacements
from contactsim.errors import InputError, Words
from contactsim.grid import Array, Grid, Threads
from contactsim.solvers.base import Result, pressed_scene, solve
from contactsim.solvers.registry import default_solver
from contactsim.status import Status
from contactsim.traits import Trait

ROUNDING = 1e-13
"""Relative rounding of the traction at which all slides."""
LEAST_SHARE = 1e-7
"""Share of the traction at which all slides; under smaller ones all sticks, and tractions are in proportion to them."""
DEPTH = 10.0
"""Depth of the surface outside the contact, over the range of the displacement."""
FLOOR = 1e-14
"""Rounding of a displacement, over its size."""


@dataclass(frozen=True)
class PartialSlip:
    """A sheared contact.

    Parameters
    ----------
    traction
        Tangential traction along x, (n,) or (ny, nx), in the unit of pressure.
    stick, slip
        Points in contact that stick and that slip, bool, of the same shape.
    shift
        Distance by which one body has moved along the other far away, in the unit of length, measured where the
        approach is. Where heights repeat, the mean displacement is not in it.
    misfit
        How unevenly the points that stick are displaced: rms difference from the shift, over the shift. NaN on a free
        half-space, and where nothing sticks or is shifted.
    slip_angle
        Rms angle between slip and traction where points slip, degrees; by Coulomb's law it is zero. NaN likewise.
    residual
        Largest error of the traction, recomputed from it: of the total, of |q| ≤ μp, and of q = μp at points that slip,
        over the mean shear traction Q; of equal displacements where points stick, and of lagging behind where they
        slip, over the shift or, if it is larger, Q·spacing/E*. Displacements are those of Poisson's ratio zero.
    status
        Converged if the residual is within the tolerance, else `INEXACT`.
    """

    traction: Array = field(repr=False)
    stick: Array = field(repr=False)
    slip: Array = field(repr=False)
    shift: float
    misfit: float
    slip_angle: float
    residual: float
    status: Status

    @property
    def relative_stick_area(self) -> float:
        """Fraction of points that stick."""
        return float(self.stick.mean())

    @property
    def relative_slip_area(self) -> float:
        """Fraction of points that slip."""
        return float(self.slip.mean())


@checked
def partial_slip(
    result: Result,
    *,
    shear_traction: float,
    friction_coefficient: Positive,
    poisson_ratio: PoissonRatio | None = None,
    tolerance: Positive = 1e-6,
    threads: Threads = 1,
) -> PartialSlip:
    """Shear a pressed contact, and return where it sticks and slips.

    The load is applied first. The shear then grows along x to its value, with Coulomb's law at each point.

    Parameters
    ----------
    result : Result
        A state on a half-space, from `contactsim.press`.
    shear_traction : float
        Tangential load along x over the length or area of the heights, 0 up to the friction coefficient times the mean
        pressure of the result, at which all slides. The mean of the traction is this number, to rounding.
    friction_coefficient : float
        Coefficient of friction μ.
    poisson_ratio : float, optional
        Poisson's ratio of both bodies, required of a surface, above -1 and at most 0.5. On lines nothing depends on it.
    tolerance : float
        Largest residual; see `PartialSlip`. The pressure of the result is taken as it is.
    threads : int
        Threads of the transforms.

    Returns
    -------
    PartialSlip
        Tangential traction, points that stick and slip, and shift. On a free half-space the shift is that of contacts
        which are alike in all directions, such as round ones.

    Raises
    ------
    InputError
        For an input that cannot be used.

    References
    ----------
    M. Ciavarella, J. Appl. Mech. 65, 998 (1998); J. Jäger, J. Tribology 120, 677 (1998).
    """
    scene = pressed_scene(result)
    _check_bodies(scene, poisson_ratio)
    sliding = friction_coefficient * result.mean_pressure
    if not 0 <= shear_traction <= sliding * (1 + ROUNDING):
        allowed = f"from 0 to {sliding:g}, the friction coefficient times the mean pressure, at which all slides"
        raise InputError("shear_traction", shear_traction, allowed)
    friction_coefficient, shear_traction = float(friction_coefficient), float(shear_traction)
    share = min(shear_traction / sliding, 1.0) if shear_traction else 0.0
    problem, scale = _pose_remainder(scene, result, max(share, LEAST_SHARE), tolerance, threads)
    remainder = solve(default_solver(scene), problem, scale).pressure
    limit = friction_coefficient * result.pressure
    traction = np.clip(limit - friction_coefficient * remainder, -limit, limit)
    stick = result.contact & ((remainder > 0) | (share < LEAST_SHARE))
    slip = result.contact & ~stick
    if stick.any():
        traction[stick] *= (shear_traction * traction.size - traction[slip].sum()) / traction[stick].sum()
    moved = scale.step * problem.compliance(traction / scale.pressure)
    shift = float(moved[stick].mean() if stick.any() else moved[slip].max(initial=0.0))
    unit = shear_traction * scale.step / scale.pressure  # Q·spacing/E*
    residual = _residual(traction, limit, stick, slip, shear_traction, (moved - shift) / (max(abs(shift), unit) or 1.0))
    shift = _shift_ratio(scene, poisson_ratio) * shift if abs(shift) > tolerance * unit else 0.0
    motion = shift, np.nan, np.nan
    if Trait.HALF_SPACE in scene.traits and stick.any() and shift:
        body, grid = HalfSpace(scene.contact_modulus, poisson_ratio), Grid(traction.shape, scene.lengths, threads)
        motion = _read_motion(shear_displacements(body, grid, traction), stick, slip)
    status = Status.CONVERGED if residual <= tolerance else Status.INEXACT
    return PartialSlip(traction, stick, slip, *motion, residual, status)


def _check_bodies(scene: Scene, poisson_ratio: float | None) -> None:
    """Raise an InputError for a layer, and for a surface without a Poisson's ratio."""
    if not {Trait.HALF_SPACE, Trait.FREE} & scene.traits:
        raise InputError("result", Words("one of a layer"), "one of a half-space, which is alike along and across")
    if poisson_ratio is None and Trait.SURFACE in scene.traits:
        raise InputError("poisson_ratio", poisson_ratio, "a number, above -1 and at most 0.5, of a surface")


def _pose_remainder(
    scene: Scene, result: Result, share: float, tolerance: float, threads: int
) -> tuple[HardWallProblem, Scale]:
    """Return the problem of the smaller pressure, under a load less a share of it, and its units.

    Its heights are the surface as the result displaces it, and far below that outside the contact. Under the full load
    the result solves this problem to rounding, whatever its own tolerance.
    """
    step = load_step(None, result.mean_pressure, "load")
    heights = scene.upper.surface.heights(result.pressure.shape[-1])
    problem, scale = pose_hard_wall(replace(scene, path=LoadPath((step,))), step, heights, tolerance, threads)
    load = result.mean_pressure / scale.pressure
    moved = problem.compliance(result.pressure / scale.pressure)
    shape = np.where(result.contact, moved, moved.min() - DEPTH * np.ptp(moved))
    error = max(tolerance / 2 * min(share, 1 - share) * load, FLOOR * float(np.abs(moved).max()))
    profile = Profile(shape, float(shape.max()), 1.0)
    return replace(problem, profile=profile, tolerance=error, load=(1 - share) * load), scale


def _shift_ratio(scene: Scene, poisson_ratio: float | None) -> float:
    """Return the ratio of tangential to normal displacements, on a surface the mean over all directions of waves."""
    if Trait.LINE in scene.traits or poisson_ratio is None:
        return 1.0
    return (2 - poisson_ratio) / (2 * (1 - poisson_ratio))


def _residual(traction: Array, limit: Array, stick: Array, slip: Array, shear: float, lead: Array) -> float:
    """Return the largest error of a traction; lead: displacement beyond the shift, over its unit."""
    size = shear or 1.0
    errors = (
        abs(traction.mean() - shear) / size,
        np.max(np.abs(traction) - limit) / size,
        np.abs(traction - limit)[slip].max(initial=0.0) / size,
        np.abs(lead[stick]).max(initial=0.0),
        lead[slip].max(initial=0.0),
    )
    return float(np.max(errors))


def _read_motion(displacements: tuple[Array, Array], stick: Array, slip: Array) -> tuple[float, float, float]:
    """Return shift, misfit and slip angle from the displacements along and across the shear."""
    along, across = displacements
    shift = float(along[stick].mean())
    misfit = float(np.sqrt(np.mean((along[stick] - shift) ** 2 + across[stick] ** 2)) / shift)
    angles = np.arctan2(across[slip], shift - along[slip])
    return shift, misfit, float(np.degrees(np.sqrt(np.mean(angles**2)))) if slip.any() else np.nan
