"""Bodies of several thicknesses: curves, labels and legends of what is drawn of them."""

from __future__ import annotations

from itertools import product

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim import notation
from contactsim.figures import style

FAINT = 0.35
"""Opacity of what is drawn beside what counts."""
LINES = ("-", ":", "-.", "--")
"""Lines of thicknesses, the largest first."""
SHADES = {"kappa_r": 1.0, "relative_contact_area": FAINT}
"""Opacity of the changes drawn; the grid errors over pairs are as faint as those of the area."""


def _line(data: xr.Dataset, thickness: float) -> str:
    """Line style of a thickness."""
    place = list(np.sort(data.thickness.values)[::-1]).index(thickness)
    return LINES[min(place, len(LINES) - 1)]


def curves(data: xr.Dataset, axes: list[Axes]) -> None:
    """Area, κ_r, their changes from the thickest body and the grid error: a curve for each H, Poisson's ratio and body.

    Of the thickest body κ_r is drawn over pairs of neighbours in contact too.
    """
    area, factor, change, last = axes
    thickest = float(data.thickness.max())
    for hurst, ratio, thickness in product(data.hurst.values, data.poisson_ratio.values, data.thickness.values):
        one = data.sel(hurst=hurst, poisson_ratio=ratio, thickness=thickness)
        look = style.poisson(ratio) | {"color": style.hurst_colour(hurst), "linewidth": 0.9}
        look["linestyle"] = _line(data, thickness)
        pressure = one.reduced_pressure_contact_mean
        style.with_errors(area, pressure, one, "relative_contact_area", **look)
        style.with_errors(factor, pressure, one, "kappa_r", **look)
        if thickness == thickest:
            style.with_errors(factor, pressure, one, "kappa_r_pairs", **look, alpha=FAINT)
        style.grid_error(last, pressure, one, "kappa_r", **look)
        style.grid_error(last, pressure, one, "kappa_r_pairs", **look, alpha=FAINT)
        if thickness < thickest:
            for name, alpha in SHADES.items():
                moved, error = one[f"{name}_change"], one[f"{name}_change_standard_error"]
                style.bars(change, one.reduced_pressure, moved, error, **look, alpha=alpha)


def frame(data: xr.Dataset, axes: list[Axes], kappa_r: float) -> None:
    """Labels, letters and legends."""
    area, factor, change, last = axes
    area.set(yscale="log", ylabel=r"relative contact area $a_{\mathrm{rel}}$")
    factor.set(ylabel=r"$\kappa_r^{1D}$")
    style.keep_in_view(factor, kappa_r - 0.1, kappa_r + 0.1)
    change.set(ylabel=rf"relative change from $h={_power(data.thickness.max())}$ nm")
    last.set(yscale="log", ylabel=r"grid error of $\kappa_r^{1D}$")
    for panel, letter in zip(axes, "abcd", strict=True):
        panel.set(xscale="log", xlabel="reduced pressure " + (r"$p^*$" if panel is change else r"$p_r^*$"))
        style.letter(panel, letter)
    colours = {f"$H={value:g}$": style.hurst_colour(value) for value in data.hurst.values}
    bodies = {f"$h={_power(value)}$ nm": _line(data, value) for value in data.thickness.values}
    keys = style.key(colours, bodies | {f"thesis, {kappa_r:g}": (0, (6, 3))})
    area.legend(handles=keys + style.poisson_key(data.poisson_ratio.values), loc="upper left")
    change.legend(handles=_shades({notation.SYMBOLS[name]: alpha for name, alpha in SHADES.items()}), loc="lower right")
    factor.legend(handles=_shades({"Eq. 3.8": 1.0, "pairs in contact": FAINT}), loc="upper right")
    last.legend(handles=_shades({"Eq. 3.8": 1.0, "pairs in contact": FAINT}), loc="lower left")


def _shades(names: dict[str, float]) -> list[Line2D]:
    return [Line2D([], [], color=style.EXACT, alpha=alpha, lw=1.5, label=name) for name, alpha in names.items()]


def _power(value: float) -> str:
    """A number as it is, a large one as a power of ten."""
    return f"{value:g}" if value < 1e5 else f"10^{{{np.log10(value):.3g}}}"
