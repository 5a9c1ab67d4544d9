"""Partial slip: a contact that is pressed, and then sheared, under Coulomb's law of friction.

Where the bodies are alike, the tangential traction is a difference of two pressures: that of the load P, and that of a
smaller one at which the contact is the stick area,

    q = μ (p(P) - p(P - Q/μ)).

Within the stick area both states differ by a rigid approach, so q shifts it as a whole, and around it q is μp. This is
exact on lines, and on surfaces where Poisson's ratio is zero. Elsewhere the tractions do not shift all points of the
stick area alike, and also displace them across the shear. The misfit tells by how much.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from contactsim.contact.loading import LoadPath, load_step
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.elasticity.base import check_poisson_ratio
from contactsim.errors import POSITIVE, InputError, Words, is_number, is_positive
from contactsim.grid import Array, Grid
from contactsim.solvers.base import Result, solve
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
        Distance by which one body has moved along the other far away, in the unit of length: relative to the same place
        as the approach.
    misfit
        Rms difference between the shift and the tangential displacement of the points that stick, over the shift: the
        error of the theory and of the solutions. NaN on a free half-space and without stick or shift.
    status
        Status of the pressure of the stick area.
    """

    traction: Array = field(repr=False)
    stick: Array = field(repr=False)
    slip: Array = field(repr=False)
    shift: float
    misfit: float
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
        A state on a half-space, from `contactsim.press`. Tractions are differences of pressures: press with a tolerance
        like the one here.
    shear_traction : float
        Tangential load along x over the length or area of the heights, 0 up to the friction coefficient times the mean
        pressure, at which all slides.
    friction_coefficient : float
        Coefficient of friction μ.
    poisson_ratio : float, optional
        Poisson's ratio of both bodies, required of a surface, above -1 and at most 0.5. On lines nothing depends on it.
    tolerance : float
        Gap in contact and overlap outside, in grid steps.
    threads : int
        Threads of the transforms.

    Returns
    -------
    PartialSlip
        Tangential traction, points that stick and slip, and shift.

    Raises
    ------
    InputError
        For an input that cannot be used.

    References
    ----------
    M. Ciavarella, J. Appl. Mech. 65, 998 (1998); J. Jäger, Arch. Appl. Mech. 68, 159 (1998).
    """
    ratio = _shift_ratio(result, poisson_ratio)
    if not is_positive(friction_coefficient):
        raise InputError("friction_coefficient", friction_coefficient, POSITIVE)
    sliding = friction_coefficient * result.mean_pressure
    if not is_number(shear_traction) or not 0 <= shear_traction <= sliding * (1 + ROUNDING):
        allowed = f"0 up to {sliding:g}, the friction coefficient times the mean pressure: there all slides"
        raise InputError("shear_traction", shear_traction, allowed)
    assert result.scene is not None
    step = load_step(None, max(result.mean_pressure - shear_traction / friction_coefficient, 0.0), "load")
    scene = replace(result.scene, path=LoadPath((step,)))
    heights = scene.upper.surface.heights(result.pressure.shape[-1])
    inner = solve(default_solver(scene), *pose_hard_wall(scene, step, heights, tolerance, threads))
    traction = friction_coefficient * (result.pressure - inner.pressure)
    stick = inner.contact & result.contact
    shift = ratio * friction_coefficient * (result.approach - inner.approach)
    misfit = np.nan
    if Trait.HALF_SPACE in scene.traits and stick.any() and shift:
        displacements = _displacements(
            Grid(traction.shape, scene.lengths, threads), scene.contact_modulus, poisson_ratio or 0.0, traction
        )
        along, across = (part[stick] for part in displacements)
        misfit = float(np.sqrt(np.mean((along - shift) ** 2 + across**2)) / shift)
    return PartialSlip(traction, stick, result.contact & ~stick, shift, misfit, inner.status)


def _shift_ratio(result: Result, poisson_ratio: float | None) -> float:
    """Return the ratio of tangential to normal displacements of the bodies of a result."""
    if not isinstance(result, Result) or result.scene is None or not result.status.solved:
        raise InputError("result", result, "a converged result of `contactsim.press`")
    if not {Trait.HALF_SPACE, Trait.FREE} & result.scene.traits:
        raise InputError("result", Words("one of a layer"), "one of a half-space, which is alike along and across")
    if poisson_ratio is None:
        if Trait.SURFACE in result.scene.traits:
            raise InputError("poisson_ratio", poisson_ratio, "a number, above -1 and at most 0.5, of a surface")
        return 1.0
    check_poisson_ratio(poisson_ratio)
    if Trait.LINE in result.scene.traits:
        return 1.0
    return (2 - poisson_ratio) / (2 * (1 - poisson_ratio))


def _displacements(grid: Grid, contact_modulus: float, poisson_ratio: float, traction: Array) -> tuple[Array, Array]:
    """Return the displacements along and across a shear of two half-spaces, relative to each other, without means."""
    wavenumber = grid.wavenumber
    compliance = np.divide(2.0, contact_modulus * wavenumber, out=np.zeros_like(wavenumber), where=wavenumber > 0)
    sheared = compliance * grid.forward(traction)
    if len(grid.shape) == 1:
        return grid.backward(sheared), np.zeros_like(traction)
    angle = np.arctan2(
        np.fft.fftfreq(grid.shape[0], grid.spacing[0])[:, None], np.fft.rfftfreq(grid.shape[1], grid.spacing[1])
    )
    softening = 1 / (1 - poisson_ratio)
    along = softening * (1 - poisson_ratio * np.cos(angle) ** 2) * sheared
    across = -softening * poisson_ratio * np.sin(angle) * np.cos(angle) * sheared
    return grid.backward(along), grid.backward(across)
