"""Partial slip: a contact that is pressed, and then sheared, under Coulomb's law of friction.

Where the bodies are alike, the tangential traction is a difference of two pressures: that of the load P, and that of a
smaller one at which the contact is the stick area,

    q = μ (p(P) - p(P - Q/μ)).

Within the stick area both states differ by a rigid approach, so q shifts it as a whole, and around it q is μp. This is
exact on lines, and on surfaces where Poisson's ratio is zero. Elsewhere the tractions do not shift all points of the
stick area alike, and slip is not everywhere against the traction. Two numbers tell by how much.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from contactsim.contact.loading import LoadPath, load_step
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Scene
from contactsim.elasticity.base import check_poisson_ratio
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.shear import shear_displacements
from contactsim.errors import POSITIVE, InputError, Words, is_number, is_positive
from contactsim.grid import Array, Grid
from contactsim.solvers.base import Result, pressed_scene, solve
from contactsim.solvers.registry import default_solver
from contactsim.status import Status
from contactsim.traits import Trait

ROUNDING = 1e-12
"""Relative rounding of the traction at which all slides."""


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
    status
        Status of both pressures.
    """

    traction: Array = field(repr=False)
    stick: Array = field(repr=False)
    slip: Array = field(repr=False)
    shift: float
    misfit: float
    slip_angle: float
    status: Status

    @property
    def relative_stick_area(self) -> float:
        """Fraction of points that stick."""
        return float(self.stick.mean())

    @property
    def relative_slip_area(self) -> float:
        """Fraction of points that slip."""
        return float(self.slip.mean())


def partial_slip(
    result: Result,
    *,
    shear_traction: float,
    friction_coefficient: float,
    poisson_ratio: float | None = None,
    tolerance: float = 1e-6,
    threads: int = 1,
) -> PartialSlip:
    """Shear a pressed contact, and return where it sticks and slips.

    The load is applied first. The shear then grows along x to its value, with Coulomb's law at each point.

    Parameters
    ----------
    result : Result
        A state on a half-space, from `contactsim.press`.
    shear_traction : float
        Tangential load along x over the length or area of the heights, 0 up to the friction coefficient times the mean
        pressure, at which all slides.
    friction_coefficient : float
        Coefficient of friction μ.
    poisson_ratio : float, optional
        Poisson's ratio of both bodies, required of a surface, above -1 and at most 0.5. On lines nothing depends on it.
    tolerance : float
        Gap in contact and overlap outside, in grid steps. Tractions are small differences of two pressures: a result
        that is less exact is solved once more. The solver is the default one.
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
    if not is_positive(friction_coefficient):
        raise InputError("friction_coefficient", friction_coefficient, POSITIVE)
    sliding = friction_coefficient * result.mean_pressure
    if not is_number(shear_traction) or not 0 <= shear_traction <= sliding * (1 + ROUNDING):
        allowed = f"from 0 to {sliding:g}, the friction coefficient times the mean pressure, at which all slides"
        raise InputError("shear_traction", shear_traction, allowed)
    inner_pressure = max(result.mean_pressure - shear_traction / friction_coefficient, 0.0)
    inner = _press(scene, result, inner_pressure, tolerance, threads)
    is_exact = result.record.certificate.met(tolerance)
    outer = result if is_exact else _press(scene, result, result.mean_pressure, tolerance, threads)
    traction = friction_coefficient * np.clip(outer.pressure - inner.pressure, 0.0, outer.pressure)
    stick = inner.contact & outer.contact
    slip = outer.contact & ~stick
    shift = friction_coefficient * _shift_ratio(scene, poisson_ratio) * _change_of_approach(outer, inner)
    motion = shift, np.nan, np.nan
    if Trait.HALF_SPACE in scene.traits and stick.any() and shift:
        body, grid = HalfSpace(scene.contact_modulus, poisson_ratio), Grid(traction.shape, scene.lengths, threads)
        motion = _read_motion(shear_displacements(body, grid, traction), stick, slip)
    status = next((state.status for state in (outer, inner) if not state.status.solved), Status.CONVERGED)
    return PartialSlip(traction, stick, slip, *motion, status)


def _check_bodies(scene: Scene, poisson_ratio: float | None) -> None:
    """Raise an InputError for a layer, and for a surface without a Poisson's ratio."""
    if not {Trait.HALF_SPACE, Trait.FREE} & scene.traits:
        raise InputError("result", Words("one of a layer"), "one of a half-space, which is alike along and across")
    if poisson_ratio is not None:
        check_poisson_ratio(poisson_ratio)
    elif Trait.SURFACE in scene.traits:
        raise InputError("poisson_ratio", poisson_ratio, "a number, above -1 and at most 0.5, of a surface")


def _press(scene: Scene, result: Result, pressure: float, tolerance: float, threads: int) -> Result:
    """Return the heights of a result, pressed at a mean pressure."""
    step = load_step(None, pressure, "load")
    again = replace(scene, path=LoadPath((step,)))
    heights = scene.upper.surface.heights(result.pressure.shape[-1])
    return solve(default_solver(again), *pose_hard_wall(again, step, heights, tolerance, threads))


def _shift_ratio(scene: Scene, poisson_ratio: float | None) -> float:
    """Return the ratio of tangential to normal displacements, on a surface the mean over all directions of waves."""
    if Trait.LINE in scene.traits or poisson_ratio is None:
        return 1.0
    return (2 - poisson_ratio) / (2 * (1 - poisson_ratio))


def _change_of_approach(outer: Result, inner: Result) -> float:
    """Return the difference of two approaches; zero without contact, and in full contact, where only means differ."""
    change = outer.approach - inner.approach
    return change if outer.contact.any() and abs(change) > ROUNDING * abs(outer.approach) else 0.0


def _read_motion(displacements: tuple[Array, Array], stick: Array, slip: Array) -> tuple[float, float, float]:
    """Return shift, misfit and slip angle from the displacements along and across the shear."""
    along, across = displacements
    shift = float(along[stick].mean())
    misfit = float(np.sqrt(np.mean((along[stick] - shift) ** 2 + across[stick] ** 2)) / shift)
    angles = np.arctan2(across[slip], shift - along[slip])
    return shift, misfit, float(np.degrees(np.sqrt(np.mean(angles**2)))) if slip.any() else np.nan
