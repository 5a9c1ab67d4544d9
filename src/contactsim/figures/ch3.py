"""Chapter 3: contact without adhesion. Each function plots one figure and returns the numbers that it shows.

Keyword arguments are values of the thesis, from `reference` in the config.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim.analysis.ratios import ratio_curves
from contactsim.analysis.resolution import grid_counts, grid_name, ratio_table
from contactsim.figures import style
from contactsim.figures.maps import SurfaceFields, plot_fields
from contactsim.figures.parts import line_fits, proportionality, ratios, resolution
from contactsim.reference import hard_wall
from contactsim.variables import find_variable

AVERAGES = tuple(f"{name}{end}" for name in ("relative_contact_area", "kappa", "kappa_r") for end in ("", "_corrected"))
PERSSON: dict[str, Any] = {proportionality.PERSSON_LABEL: "-."}
BOTH_PRESSURES = r"reduced pressure $p^*$, $p_r^*$"


def fig_3_2(data: xr.Dataset, axes: list[Axes], *, kappa_r: float) -> pd.DataFrame:
    """Plot the area of lines against both reduced pressures, and the factors of proportionality (thesis Fig. 3.2)."""
    area, both, contact, error = axes
    proportionality.plot_areas(area, data)
    proportionality.plot_factors(both, data, ("kappa", "kappa_r"))
    proportionality.plot_factors(contact, data, ("kappa_r",))
    proportionality.plot_grid_errors(error, data, ("kappa", "kappa_r"))
    proportionality.plot_persson(area, both, data)
    for panel in (both, contact):
        panel.axhline(kappa_r, color=style.EXACT, lw=0.8, ls=style.THESIS, label=f"thesis, {kappa_r:g}")
    both.set(ylabel=r"$\kappa^{1D}$, $\kappa_r^{1D}$")
    contact.set(ylabel=r"$\kappa_r^{1D}$")
    error.set(ylabel=r"grid error of $\kappa^{1D}$, $\kappa_r^{1D}$ (%)")
    for panel in axes:
        panel.set(xscale="log", xlabel=r"reduced pressure $p_r^*$" if panel is contact else BOTH_PRESSURES)
    style.add_letters(axes)
    area.legend(handles=_handles(data), loc="upper left")
    style.add_log_headroom(area, 0.2)
    both.legend(handles=_gradient_handles({f"thesis, {kappa_r:g}": style.THESIS} | PERSSON), loc="upper right")
    style.add_headroom(both, 0.3)
    style.add_headroom(contact, 0.0, below=0.3)
    contact.text(0.03, 0.03, proportionality.trend_text(data), transform=contact.transAxes, fontsize=7, va="bottom")
    error.legend(handles=proportionality.estimator_handles(), loc="upper right")
    style.add_log_headroom(error, 0.25)
    return style.mean_table(data, AVERAGES)


def fig_3_4(data: xr.Dataset, axes: list[Axes], *, kappa: float, kappa_r: float) -> pd.DataFrame:
    """Plot the area of surfaces against both reduced pressures, and the factors (thesis Fig. 3.4)."""
    area, factor, distance, error = axes
    levels = {"kappa": kappa, "kappa_r": kappa_r}
    proportionality.plot_areas(area, data)
    proportionality.plot_factors(factor, data, levels)
    proportionality.plot_distances(distance, data, levels)
    proportionality.plot_grid_errors(error, data, levels)
    proportionality.plot_persson(area, factor, data)
    for name, value in levels.items():
        factor.axhline(value, color=proportionality.FACTOR_COLOURS[name], lw=0.6, label=f"thesis, {value:.2f}")
    factor.set(ylabel=r"$\kappa^{2D}$, $\kappa_r^{2D}$")
    distance.set(ylabel=rf"above {kappa:.2f} ($\kappa^{{2D}}$), {kappa_r:.2f} ($\kappa_r^{{2D}}$) (%)")
    error.set(ylabel=r"grid error of $\kappa^{2D}$, $\kappa_r^{2D}$ (%)")
    for panel in axes:
        panel.set(xscale="log", xlabel=BOTH_PRESSURES)
    style.add_letters(axes)
    area.legend(handles=_handles(data), loc="upper left")
    style.add_log_headroom(area, 0.2)
    thesis = [
        Line2D([], [], color=proportionality.FACTOR_COLOURS[name], lw=0.6, label=f"thesis, {value:.2f}")
        for name, value in levels.items()
    ]
    factor.legend(handles=_gradient_handles(PERSSON) + thesis, loc="upper right")
    style.add_headroom(factor, 0.55)
    error.legend(handles=proportionality.estimator_handles(), loc="upper right")
    style.add_log_headroom(error, 0.25)
    return style.mean_table(data, AVERAGES)


def _handles(data: xr.Dataset) -> list[Line2D]:
    """Return legend handles of Hurst exponents, of the estimators and of Persson's line."""
    exponents = style.hurst_handles(data.hurst_exponent.values)
    return exponents + proportionality.estimator_handles() + style.line_handles(PERSSON)


def _gradient_handles(lines: dict[str, Any]) -> list[Line2D]:
    """Return legend handles of the gradients' colours and of lines."""
    return style.colour_handles(proportionality.GRADIENTS) + style.line_handles(lines)


def fig_3_2_grid(data: xr.Dataset, finer: xr.Dataset, axes: list[Axes], *, kappa_r: float) -> pd.DataFrame:
    """Plot the factors of proportionality of lines on finer and finer grids."""
    return resolution.plot_grids(data, finer, axes, {"kappa_r": kappa_r})


def fig_3_4_grid(
    data: xr.Dataset, finer: xr.Dataset, axes: list[Axes], *, kappa: float, kappa_r: float
) -> pd.DataFrame:
    """Plot the factors of proportionality of surfaces on finer and finer grids."""
    return resolution.plot_grids(data, finer, axes, {"kappa": kappa, "kappa_r": kappa_r})


def fig_3_5(
    line: xr.Dataset,
    surface: xr.Dataset,
    lines_finer: xr.Dataset,
    surfaces_finer: xr.Dataset,
    axes: list[Axes],
    *,
    ratio: float,
) -> pd.DataFrame:
    """Plot the factors of lines over those of surfaces (thesis Fig. 3.5); ratio: the thesis's, of κ_r."""
    equal = ratio_table(lines_finer, surfaces_finer)
    own = pd.concat([ratio_curves(line, surface, f"{name}_corrected") for name in proportionality.FACTOR_COLOURS])
    finest = grid_name(grid_counts(equal.grid)[-1])
    for panel, (name, colour), symbol in zip(
        axes, proportionality.FACTOR_COLOURS.items(), (r"\kappa", r"\kappa_r"), strict=True
    ):
        ratios.plot_equal_grids(panel, equal[equal.quantity == name], finest, colour)
        ratios.plot_curves(panel, own[own.quantity == f"{name}_corrected"], colour)
        panel.set(xscale="log", xlabel=r"reduced pressure $p^*$", ylabel=rf"${symbol}^{{1D}}/{symbol}^{{2D}}$")
    axes[0].legend(handles=style.hurst_handles(surface.hurst_exponent.values), loc="upper right")
    smooth = hard_wall.CYLINDER_KAPPA_R / hard_wall.SPHERE_KAPPA_R
    lines = {f"thesis, {ratio:g}": (ratio, style.THESIS), f"cylinder over sphere, exact, {smooth:.3f}": (smooth, "-")}
    for words, (value, look) in lines.items():
        axes[1].axhline(value, color=style.EXACT, lw=0.8, ls=look, label=words)
    handles = style.line_handles({words: look for words, (_, look) in lines.items()})
    axes[1].legend(handles=ratios.ratio_handles(finest) + handles, loc="upper right")
    style.share_vertical_range(axes)
    style.add_letters(axes)
    return pd.concat([own.assign(grid="own"), equal])[
        ["grid", "quantity", "hurst_exponent", "reduced_pressure", "value", "error", "spread"]
    ]


def maps(fields: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Map contact, pressure and gap of one rough surface at one load."""
    surface_fields = SurfaceFields.of_dataset(fields)
    unit = float(fields.rms_gradient.squeeze() * fields.contact_modulus)
    reduced = surface_fields.pressure / unit
    surface_fields = replace(surface_fields, pressure=reduced, pressure_unit=r"$E^*\bar g$")
    places = {dim: fields[dim].item() for dim in fields.status.dims if dim != "member"}
    labels = [f"{find_variable(dim).symbol or dim} = {value:g}" for dim, value in places.items()]
    axes[0].text(1, -0.03, ", ".join(labels), transform=axes[0].transAxes, fontsize=8, ha="right", va="top")
    return plot_fields(surface_fields, axes).assign(**places)


def fig_3_3(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the fits of Eq. 3.11 to each Hurst exponent and to all, one panel a weighting (thesis Fig. 3.3).

    Returns the constants of every fit, and κ of it at each load of the data.
    """
    lowest = data.sel(fit_limit=float(data.fit_limit.min()))
    for panel, (weighting, words) in zip(axes, line_fits.WEIGHTINGS.items(), strict=True):
        line_fits.plot_fits(panel, lowest.sel(weighting=weighting))
        panel.set_title(f"fit of {words}", fontsize=9)
        panel.set(xscale="log", xlabel=r"reduced pressure $p^*$", ylabel=r"$\kappa^{1D}_{\mathrm{fit}}$")
        style.add_headroom(panel, 0.62)
        panel.legend(handles=line_fits.fit_handles(lowest.sel(weighting=weighting)), loc="upper right", fontsize=7)
    style.share_vertical_range(axes)
    style.add_letters(axes)
    return line_fits.fit_table(data)
