"""Smooth adhesive asperities: profiles about the highest point, contact sizes, and the limits of the pull-off load."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
import xarray as xr

from contactsim.analysis import scales
from contactsim.grid import Array
from contactsim.reference import adhesion


def centred_nodes(data: xr.Dataset) -> tuple[Array, Array]:
    """Return positions from the highest point of the upper surface, nm, ascending, and the nodes that they belong to.

    data: of one path, or of one member of several
    """
    heights = data.heights.isel(member=0) if "member" in data.heights.dims else data.heights
    middle, count = int(np.argmax(heights.values)), data.x.size
    nodes = (np.arange(count) - count // 2 + middle) % count
    return (np.arange(count) - count // 2) * float(data.length) / count, nodes


def contact_sizes(data: xr.Dataset) -> pd.DataFrame:
    """Return the contact length over the radius at each ratio of works, with its grid error (NaN if not measured)."""
    radius = scales.radius(data)
    error = data.get("final_contact_length_grid_error")
    table = {
        "work_ratio": data.work_ratio.values,
        "size_ratio": data.final_contact_length.isel(member=0).values / radius,
        "error": np.full(data.work_ratio.size, np.nan) if error is None else error.values / radius,
    }
    return pd.DataFrame(table)


def pull_off_table(data: xr.Dataset, legs: Sequence[str]) -> pd.DataFrame:
    """Return the pull-off loads of both legs against the work of separation, with grid errors (NaN if not measured)."""
    table = pd.DataFrame({"work_of_separation": data.work_of_separation.values})
    for leg in legs:
        name = f"pull_off_load_{leg}"
        error = data.get(f"{name}_grid_error")
        table[name] = data[name].values
        table[f"{name}_grid_error"] = np.nan if error is None else error.values
    return table


def pull_off_limits(data: xr.Dataset, poisson_ratio: float, work: Array) -> dict[str, Array]:
    """Return the reduced pull-off loads of a cylinder in its two limits, and between them.

    "JKR": on an elastic half-space; "rigid": of rigid bodies under the normal law; "Maugis": on a half-space under a
    uniform traction with the strength and the work of the law, which is proportional to the work.
    """
    radius, modulus = scales.radius(data), scales.plane_strain_modulus(data, poisson_ratio)
    length = scales.LawScales.of(data).normal_length
    maugis = [
        float(
            adhesion.maugis_cylinder_pull_off(own, radius, modulus, float(adhesion.normal_strength(own, length, 0.0)))
        )
        for own in work
    ]
    limits = {
        "JKR": adhesion.cylinder_pull_off(work, radius, modulus),
        "Maugis": np.array(maugis),
        "rigid": adhesion.rigid_cylinder_pull_off(work, radius, length),
    }
    return {name: scales.reduced_line_load(load, data) for name, load in limits.items()}


def local_slopes(work: Array, load: Array) -> tuple[Array, Array]:
    """Return the middles of neighbouring works of separation, and d ln load / d ln work between them."""
    return np.sqrt(work[1:] * work[:-1]), np.diff(np.log(load)) / np.diff(np.log(work))
