"""Factors of proportionality of area and pressure: exact, fitted, and in words how constant they are."""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim import reference
from contactsim.analysis import ensemble
from contactsim.figures import style
from contactsim.grid import Array

ROUND = {
    "cylinder": (reference.CYLINDER_KAPPA_R, r"cylinder, exact $8/(\pi\sqrt{3})$ = 1.470"),
    "sphere": (reference.SPHERE_KAPPA_R, r"sphere, exact $3\pi/(4\sqrt{2})$ = 1.666"),
}
"""Exact κ_r of a body, and the words for it."""
FIT_LOOKS = {"area": {"lw": 1.6, "alpha": 1.0}, "logarithm": {"lw": 0.8, "alpha": 0.6}}
"""Lines of a fit by how it weighs."""


def round_body(data: xr.Dataset, exact: float) -> xr.Dataset:
    """The one member of a cylinder or sphere, with area and load without units, and the exact values."""
    one = data.isel(member=0)
    size = "contact_radius" if "contact_radius" in one else "half_width"
    radius = float(one[f"{size}_exact"][0] / one.contact_ratio[0])
    nominal = one.length / radius * (one.length_y / radius if "length_y" in one else 1.0)
    ratio = one.contact_ratio
    return one.assign(
        area=one.relative_contact_area * nominal,
        area_exact=2 * ratio if size == "half_width" else np.pi * ratio**2,
        load=one.mean_pressure * nominal / one.contact_modulus,
        kappa_r_exact=exact,
    )


def constancy(data: xr.Dataset) -> str:
    """The most significant changes of κ_r with pressure and with the Hurst exponent, in words."""
    if data.member.size < 2:
        return ""
    lines = []
    for along, text, other in (("reduced_pressure", "$p^*$", "$H$"), ("hurst", "$H$", "$p^*$")):
        found = ensemble.departure(data, "kappa_r", along)
        first, second = (place[along] for place in found.places)
        (at,) = (value for name, value in found.places[0].items() if name != along)
        lines.append(rf"{text} from {first:g} to {second:g} at {other} = {at:g}: $\kappa_r$ changes")
        lines.append(f"    by {found.difference:.3f}, {found.in_errors:.1f} standard errors")
    return "\n".join(lines)


def fit_look(name: str, weighting: str) -> dict[str, object]:
    """The fit to all is broad and lies below those to one Hurst exponent, so that both are seen where they meet."""
    look = FIT_LOOKS[weighting]
    if name == "all":
        return {"color": style.PAIRS, "lw": 2.5 * look["lw"], "alpha": 0.5 * look["alpha"], "zorder": 1.5}
    line = "-" if name == "one" else style.hurst(float(name))["linestyle"]
    return look | {"color": style.WHOLE, "ls": line}


def kappa_fit(pressure: Array, b1: Array, b2: Array) -> Array:
    """κ = a_rel/p* by Eq. 3.11; the arrays broadcast."""
    return reference.line_area(pressure, b1, b2) / pressure
