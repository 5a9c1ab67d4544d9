"""Proportionality of contact area and load: κ of Eq. 3.1 and κ_r of Eq. 3.3, and the size of smooth contacts."""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.grid import Array


def proportionality(area: Array, pressure: Array, gradient: Array, contact_modulus: float) -> Array:
    """Return κ = a_rel ḡ E*/p (Eqs 3.1 and 3.3), or κ_r with the gradient over the contact; NaN at zero pressure."""
    return np.where(pressure > 0, area * gradient * contact_modulus / np.where(pressure > 0, pressure, 1.0), np.nan)


def derive_contact_factors(data: xr.Dataset) -> xr.Dataset:
    """Return loads on their own at a hard wall with κ, κ_r, the reduced pressure in contact and the contact's size.

    Notes
    -----
    κ, of dimension `reduced_pressure`, is Eq. 3.1 and κ_r is Eq. 3.3. A contact of a cylinder has a `half_width`, that
    of a sphere a `contact_radius`, both in nm. Mean gap and contact stiffness are also given over rms height and
    gradient.
    """
    area, pressure, modulus = data.relative_contact_area, data.mean_pressure, data.contact_modulus

    def kappa(area: xr.DataArray, gradient: xr.DataArray) -> xr.DataArray:
        """Return κ for that area and gradient."""
        return xr.apply_ufunc(proportionality, area, pressure, gradient, modulus)

    data = data.assign(
        kappa_r=kappa(area, data.rms_gradient_contact),
        kappa_r_pairs=kappa(area, data.rms_gradient_contact_pairs),
        kappa_r_corrected=kappa(data.relative_contact_area_corrected, data.rms_gradient_contact_corrected),
        kappa_r_subgrid=kappa(data.relative_contact_area_subgrid, data.rms_gradient_contact_subgrid),
        reduced_pressure_contact=pressure / (data.rms_gradient_contact * modulus),
        reduced_pressure_contact_corrected=pressure / (data.rms_gradient_contact_corrected * modulus),
    )
    if "mean_gap" in data:
        data["reduced_gap"] = data.mean_gap / data.rms_height
    if "contact_stiffness" in data:
        data["reduced_stiffness"] = data.contact_stiffness * data.rms_height / (data.rms_gradient * modulus)
    if "reduced_pressure" in data.dims:
        data["kappa"] = area / data.reduced_pressure
        data["kappa_corrected"] = data.relative_contact_area_corrected / data.reduced_pressure
        data["kappa_subgrid"] = data.relative_contact_area_subgrid / data.reduced_pressure
    if "contact_ratio" in data.dims and "length_y" in data:
        data["contact_radius"] = np.sqrt(area * data.length * data.length_y / np.pi)
    elif "contact_ratio" in data.dims:
        data["half_width"] = area * data.length / 2
    return data
