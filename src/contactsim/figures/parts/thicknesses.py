"""Curves of bodies of several thicknesses, with labels and legends."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from contactsim.figures import style
from contactsim.variables import RESULTS

LINES = ("-", ":", "-.", "--")
"""Lines of thicknesses, the largest first."""
HALF_SPACE = 1e8
"""Thickness (nm) from which a layer is a half-space to rounding."""
CHANGE_OPACITIES = {"kappa_r": 1.0, "relative_contact_area": style.FAINT}
"""Opacity of the changes of each quantity."""
SHIFT = 1.06
"""Factor between the pressures at which the points of neighbouring bodies are drawn beside each other."""
FACTOR_OPACITIES = {"Eq. 3.8": 1.0, "pairs in contact": style.FAINT}
"""Opacity of κ_r and of its grid error, by definition."""


def thickness_line(data: xr.Dataset, thickness: float) -> str:
    """Return the line style of a thickness."""
    place = list(np.sort(data.thickness.values)[::-1]).index(thickness)
    return LINES[min(place, len(LINES) - 1)]


def plot_bodies(data: xr.Dataset, axes: list[Axes]) -> None:
    """Plot area, κ_r, their changes from the thickest body and the grid error of each body.

    There is a curve for each Hurst exponent, Poisson's ratio and thickness. κ_r of the thickest body is plotted over
    pairs of points in contact too.
    """
    for hurst_exponent, (place, (ratio, thickness)) in product(data.hurst_exponent.values, _placed_bodies(data)):
        body = data.sel(hurst_exponent=hurst_exponent, poisson_ratio=ratio, thickness=thickness)
        look = style.poisson_look(ratio) | {"color": style.hurst_colour(hurst_exponent), "linewidth": 0.9}
        look["linestyle"] = thickness_line(data, thickness)
        look["label"] = rf"_$H={hurst_exponent:g}$, $\nu={ratio:g}$, {_body_label(thickness)}"
        _plot_body(body, axes, look, thickness == data.thickness.max(), SHIFT**place)


def _placed_bodies(data: xr.Dataset) -> list[tuple[float, tuple[float, float]]]:
    """Return Poisson's ratio and thickness of each body, with its place beside the others, 0 in their middle."""
    bodies = list(product(data.poisson_ratio.values, data.thickness.values))
    return [(place - (len(bodies) - 1) / 2, body) for place, body in enumerate(bodies)]


def _plot_body(body: xr.Dataset, axes: list[Axes], look: dict[str, Any], thickest: bool, shift: float) -> None:
    """Plot the curves of one body; of the thickest there is no change, but κ_r over pairs.

    shift: factor of the pressure at which points are drawn, but not those of the area
    """
    area, factor, change, error = axes
    style.plot_means(area, body.reduced_pressure_contact_mean, body, "relative_contact_area", **look)
    pressure = body.reduced_pressure_contact_mean * shift
    style.plot_means(factor, pressure, body, "kappa_r", **look)
    pairs = look | {"alpha": style.FAINT, "label": f"{look['label']}, pairs in contact"}
    if thickest:
        style.plot_means(factor, pressure, body, "kappa_r_pairs", **pairs)
    style.plot_grid_error(error, pressure, body, "kappa_r", **look)
    style.plot_grid_error(error, pressure, body, "kappa_r_pairs", **pairs)
    if not thickest:
        for name, alpha in CHANGE_OPACITIES.items():
            changes = body[f"{name}_change"], body[f"{name}_change_standard_error"]
            label = f"{look['label']}, {RESULTS[name].symbol}"
            style.errorbars(change, body.reduced_pressure * shift, *changes, **look | {"alpha": alpha, "label": label})


def label_panels(data: xr.Dataset, axes: list[Axes], kappa_r: float) -> None:
    """Add labels, letters and legends; kappa_r: the thesis's value."""
    area, factor, change, error = axes
    area.set(yscale="log", ylabel=r"relative contact area $a_{\mathrm{rel}}$")
    factor.set(ylabel=r"$\kappa_r^{1D}$")
    style.include_range(factor, kappa_r - 0.1, kappa_r + 0.1)
    change.set(ylabel=f"relative change from {_body_label(float(data.thickness.max()))}")
    error.set(yscale="log", ylabel=r"grid error of $\kappa_r^{1D}$")
    for panel in axes:
        panel.set(xscale="log", xlabel="reduced pressure " + (r"$p^*$" if panel is change else r"$p_r^*$"))
    style.add_letters(axes)
    colours = {f"$H={value:g}$": style.hurst_colour(value) for value in data.hurst_exponent.values}
    lines = {_body_label(value): thickness_line(data, value) for value in data.thickness.values}
    handles = style.colour_handles(colours) + style.line_handles(lines | {f"thesis, {kappa_r:g}": style.THESIS})
    area.legend(handles=handles + style.poisson_handles(data.poisson_ratio.values), loc="upper left")
    opacities = {RESULTS[name].symbol: alpha for name, alpha in CHANGE_OPACITIES.items()}
    change.legend(handles=style.opacity_handles(opacities), loc="lower right")
    factor.legend(handles=style.opacity_handles(FACTOR_OPACITIES), loc="upper right")
    style.add_log_headroom(error, 0.15)
    error.legend(handles=style.opacity_handles(FACTOR_OPACITIES), loc="upper right", ncols=2)


def _body_label(thickness: float) -> str:
    """Return the label of a body by its thickness, nm; one that is thick beyond measure is a half-space."""
    return "half-space" if thickness >= HALF_SPACE else f"$h={thickness:g}$ nm"
