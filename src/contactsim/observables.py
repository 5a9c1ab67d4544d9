"""What is read off a solution: functions on arrays.

Contact area follows one of three named criteria; the hard wall has `touching`, points with positive pressure.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from contactsim.grid import Array
from contactsim.roughness import rms_gradient, rms_gradient_bonds

KEPT = ("contact", "pressure", "profile", "fields")
"""What a run may keep beside its numbers; all but the last by default."""


def touching(pressure: Array) -> Array:
    """Points in contact at a hard wall: positive pressure, bool of the same shape (Chapter 3)."""
    return pressure > 0


def wall_observables(heights: Array, spacing: Sequence[float], pressure: Array, gap: Array) -> dict[str, float]:
    """Numbers of one hard-wall state; heights, pressure, gap: (n,) or (ny, nx) in nm, GPa, nm; spacings nm.

    relative_contact_area; rms_gradient_contact (Eqs 3.8–3.9) and rms_gradient_contact_bond (pairs with both ends in
    contact), NaN where there is none; mean_gap, nm; mean_pressure, GPa.
    """
    contact = touching(pressure)
    return {
        "relative_contact_area": float(contact.mean()),
        "rms_gradient_contact": rms_gradient(heights, spacing, contact),
        "rms_gradient_contact_bond": rms_gradient_bonds(heights, spacing, contact),
        "mean_gap": float(gap.mean()),
        "mean_pressure": float(pressure.mean()),
    }


def proportionality(area: Array, pressure: Array, gradient: Array, contact_modulus: float) -> Array:
    """κ = a_rel ḡ E*/p (Eqs 3.1 and 3.3): with the gradient over all of the surface κ, over the contact κ_r.

    Broadcasts; NaN where the pressure is zero.
    """
    return np.where(pressure > 0, area * gradient * contact_modulus / np.where(pressure > 0, pressure, 1.0), np.nan)
