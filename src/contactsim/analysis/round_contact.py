"""Contact of a cylinder and of a sphere beside the exact answers (Table 3.1)."""

from __future__ import annotations

import numpy as np
import xarray as xr

ARRAY = ("half_width_array", "rms_gradient_array", "kappa_r_array")
"""Exact answers for parallel cylinders a period apart; spheres have none."""


def beside_exact(data: xr.Dataset) -> xr.Dataset:
    """Return the one member of a study of a cylinder or sphere with its exact answers.

    Parameters
    ----------
    data : dataset of a study with one member, by contact_ratio c/R

    Returns
    -------
    data : with `area`, corrected and exact, over R (line) or R² (sphere); `load`, over E*R or E*R²; and
        the exact answers of a periodic array, NaN for spheres
    """
    member = data.isel(member=0)
    size = "contact_radius" if "contact_radius" in member else "half_width"
    radius = float(member[f"{size}_exact"][0] / member.contact_ratio[0])
    nominal = member.length / radius * (member.length_y / radius if "length_y" in member else 1.0)
    ratio = member.contact_ratio
    if "half_width_array" not in member:
        member = member.assign({name: xr.full_like(ratio, np.nan) for name in ARRAY})
    return member.assign(
        area=member.relative_contact_area * nominal,
        area_corrected=member.relative_contact_area_corrected * nominal,
        area_array=2 * member.half_width_array / radius,
        area_exact=2 * ratio if size == "half_width" else np.pi * ratio**2,
        load=member.mean_pressure * nominal / member.contact_modulus,
    )
