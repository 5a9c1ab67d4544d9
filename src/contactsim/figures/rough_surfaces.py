"""What the contact of rough surfaces transmits: area, stiffness, distributions and patches, beside theories."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim import dataset
from contactsim.analysis.mean_errors import mean_error
from contactsim.figures import style
from contactsim.figures.parts.proportionality import persson_curve
from contactsim.grid import Array
from contactsim.reference.bush import bush_area
from contactsim.reference.persson import (
    Spectrum,
    persson_gap_density,
    persson_mean_gap,
    persson_pressure_density,
)

REDUCED_PRESSURE = r"reduced pressure $p^*$"
PERSSON, BUSH = "-.", "--"
"""Lines of the theories of Persson, and of Bush, Gibson and Thomas."""
SHADE = 0.25
"""Opacity of the error of a density."""
LEAST_DENSITY = 1e-4
"""Least density that is drawn."""
LEGEND_ROOM = 1.35
"""End of the axis of densities over the last place that is drawn: beyond it the legend stands."""
Theory = Callable[[Array, float], Array]
"""Density that a theory gives at places and a reduced pressure."""


def surface_theories(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the contact area and its ratio to the reduced pressure beside the theories."""
    area, factor = axes
    _plot_means(area, data, "relative_contact_area_corrected", data.reduced_pressure)
    _plot_means(factor, data, "kappa_corrected", data.reduced_pressure)
    pressure, persson = persson_curve(data)
    _plot_theory(axes, pressure, persson, color=style.EXACT, ls=PERSSON, label="Persson")
    nayak = data.nayak_parameter.mean("member")
    for hurst_exponent in _exponents(data):
        bush = bush_area(pressure, float(nayak.sel(hurst_exponent=hurst_exponent)))
        look = {"color": style.hurst_colour(hurst_exponent), "ls": BUSH}
        _plot_theory(axes, pressure, bush, label=f"$H={hurst_exponent:g}$, Bush, Gibson and Thomas", **look)
    area.set(xscale="log", yscale="log", xlabel=REDUCED_PRESSURE, ylabel=r"relative contact area $a_{\mathrm{rel}}$")
    factor.set(xscale="log", xlabel=REDUCED_PRESSURE, ylabel=r"$\kappa=a_{\mathrm{rel}}/p^*$")
    labels = [rf"$H={value:g}$, $\alpha={float(nayak.sel(hurst_exponent=value)):.3g}$" for value in _exponents(data)]
    area.legend(handles=_hurst_handles(data, labels), loc="upper left")
    theories = {r"Persson, erf$(\sqrt{2}p^*)$": PERSSON, "Bush, Gibson and Thomas": BUSH}
    factor.legend(handles=style.line_handles(theories), loc="upper right")
    style.add_headroom(factor, 0.2)
    style.add_letters(axes)
    table = style.mean_table(data, ("relative_contact_area_corrected", "kappa_corrected"))
    return table.merge(nayak.to_dataframe().reset_index(), on="hurst_exponent")


def surface_stiffness(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot contact stiffness, conductance and mean gap against the reduced pressure."""
    stiffness, gap = axes
    pressure = data.reduced_pressure
    _plot_means(stiffness, data, "reduced_stiffness", pressure)
    _plot_means(gap, data, "reduced_gap", pressure)
    stiffness.plot(pressure, 2 * pressure, color=style.LIGHT_GREY, lw=0.8, zorder=0, label="slope 1")
    stiffness.text(0.02, 2 * 0.02 * 1.5, "slope 1", color=style.GREY, fontsize=7, ha="right")
    label = r"$K\bar h/(E^*\bar g)=G\bar h/(2c\bar g)$"
    stiffness.set(xscale="log", yscale="log", xlabel=REDUCED_PRESSURE, ylabel=label)
    gap.set(xscale="log", xlabel=REDUCED_PRESSURE, ylabel=r"mean gap over $\bar h$")
    loads, _ = persson_curve(data)
    for hurst_exponent in _exponents(data):
        spectrum = _expected_spectrum(data, hurst_exponent)
        theory = [persson_mean_gap(load, spectrum, 1.0) / spectrum.rms_height for load in loads]
        look: dict[str, Any] = {"lw": 0.9, "ls": PERSSON, "color": style.hurst_colour(hurst_exponent), "zorder": 1}
        gap.plot(loads, theory, label=f"$H={hurst_exponent:g}$, Persson", **look)
    gap.legend(handles=style.line_handles({"Persson": PERSSON}), loc="upper right")
    stiffness.legend(handles=_hurst_handles(data), loc="upper left")
    style.add_letters(axes)
    return style.mean_table(data, ("reduced_stiffness", "reduced_gap"))


def _expected_spectrum(data: xr.Dataset, hurst_exponent: float) -> Spectrum:
    """Return the expected spectrum of the surfaces of a dataset, with an rms gradient of one."""
    surface = dataset.settings_of(data)["surface"]
    return Spectrum.self_affine(
        surface["length"], surface["long_cutoff"], surface["short_cutoff"], hurst_exponent, rms_gradient=1.0
    )


def pressure_distribution(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the density of pressure, one panel a Hurst exponent, with that of Persson."""
    theories = [_persson_density] * len(axes)
    table = _plot_densities(axes, data, "pressure_density", r"pressure $p/(E^*\bar g)$", theories)
    handles = style.line_handles({"Persson": PERSSON})
    axes[-1].legend(handles=[*_load_handles(data), *handles], loc="upper right")
    return table


def _persson_density(pressures: Array, reduced_pressure: float) -> Array:
    """Return Persson's density of p/(E* ḡ)."""
    return persson_pressure_density(pressures, reduced_pressure, 1.0, 1.0)


def gap_distribution(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the density of the gap, one panel a Hurst exponent, with that of Persson."""
    theories = [partial(_persson_gaps, _expected_spectrum(data, value)) for value in _exponents(data)]
    table = _plot_densities(axes, data, "gap_density", r"gap over $\bar h$", theories)
    handles = style.line_handles({"Persson": PERSSON})
    axes[-1].legend(handles=[*_load_handles(data), *handles], loc="upper right")
    return table


def _persson_gaps(spectrum: Spectrum, gaps: Array, reduced_pressure: float) -> Array:
    """Return Persson's density of the gap over the rms height, of a surface with an rms gradient of one."""
    height = spectrum.rms_height
    return height * persson_gap_density(gaps * height, reduced_pressure, spectrum, 1.0)


def contact_patches(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the number of patches and the share of the largest against the contact area."""
    count, share = axes
    area = data.relative_contact_area_mean
    _plot_means(count, data, "patches", area)
    _plot_means(share, data, "largest_patch_share", area)
    for hurst_exponent in _exponents(data):
        surfaces = data.sel(hurst_exponent=hurst_exponent)
        spans = surfaces.where(surfaces.spanning_mean > 0.5)
        look = style.hurst_look(hurst_exponent) | {"linestyle": "", "color": style.hurst_colour(hurst_exponent)}
        look |= {"markerfacecolor": style.hurst_colour(hurst_exponent), "zorder": 3}  # above the open markers
        look |= {"label": f"$H={hurst_exponent:g}$, a patch spans the surface"}
        share.plot(spans.relative_contact_area_mean, spans.largest_patch_share_mean, **look)
    for panel, label in ((count, "number of patches"), (share, "share of the contact in the largest patch")):
        panel.set(xscale="log", xlabel=r"relative contact area $a_{\mathrm{rel}}$", ylabel=label)
    count.set(yscale="log")
    spanning = Line2D([], [], ls="", marker="o", color=style.GREY, ms=3.5, label="a patch spans the surface")
    share.legend(handles=[*_hurst_handles(data), spanning], loc="upper left")
    style.add_letters(axes)
    return style.mean_table(data, ("patches", "largest_patch_share", "spanning"))


def challenge(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot mean gap and stiffness against the load, and pressures, gaps and patches at each load, of one surface."""
    data = data if "hurst_exponent" in data.dims else data.expand_dims(hurst_exponent=[np.nan])
    gap, stiffness, pressures, patches = axes
    _plot_means(gap, data, "reduced_gap", data.reduced_pressure)
    _plot_means(stiffness, data, "reduced_stiffness", data.reduced_pressure)
    gap.set(xscale="log", xlabel=REDUCED_PRESSURE, ylabel=r"mean gap over $\bar h$")
    stiffness.set(xscale="log", yscale="log", xlabel=REDUCED_PRESSURE, ylabel=r"$K\bar h/(E^*\bar g)$")
    _plot_density(pressures, data.isel(hurst_exponent=0), "pressure_density", _persson_density)
    pressures.set(yscale="log", ylim=(LEAST_DENSITY, None), xlabel=r"pressure $p/(E^*\bar g)$", ylabel="density")
    _end_where_all_is_zero([pressures], data.pressure_density_mean)
    pressures.legend(handles=[*_load_handles(data), *style.line_handles({"Persson": PERSSON})], loc="upper right")
    means, errors = data.patches_by_area_mean.isel(hurst_exponent=0), mean_error(data, "patches_by_area")
    for load, colour in style.shades(data.reduced_pressure.values).items():
        mean = means.sel(reduced_pressure=load)
        error = errors.isel(hurst_exponent=0).sel(reduced_pressure=load)
        seen = mean.where(mean > 0)
        look = {"color": colour, "marker": "o", "ms": 2.5, "lw": 1.0, "label": _load_label(load)}
        style.errorbars(patches, data.area_bin, seen, error, **look)
    patches.set(
        xscale="log", yscale="log", xlabel="area of a patch over that of the surface", ylabel="number of patches"
    )
    patches.legend(handles=_load_handles(data), loc="upper right")
    style.add_letters(axes)
    return style.mean_table(data, ("reduced_gap", "reduced_stiffness", "relative_contact_area_corrected", "patches"))


def _exponents(data: xr.Dataset) -> list[float]:
    """Return the Hurst exponents of a dataset."""
    return [float(value) for value in data.hurst_exponent.values]


def _hurst_handles(data: xr.Dataset, labels: Sequence[str] = ()) -> list[Line2D]:
    """Return legend handles of the Hurst exponents in their colours; labels: in place of the exponents, if any."""
    handles = style.hurst_handles(_exponents(data))
    for handle, value in zip(handles, _exponents(data), strict=True):
        handle.set_color(style.hurst_colour(value))
        handle.set_linestyle("-")
    for handle, label in zip(handles, labels, strict=False):
        handle.set_label(label)
    return handles


def _plot_means(axes: Axes, data: xr.Dataset, name: str, across: xr.DataArray) -> None:
    """Plot the means of a quantity, one curve a Hurst exponent, with all their errors."""
    means, errors = data[f"{name}_mean"], mean_error(data, name)
    x = across.broadcast_like(means)
    for value in _exponents(data):
        look = style.hurst_look(value) | {"color": style.hurst_colour(value), "linestyle": "-"}
        look |= {"label": f"$H={value:g}$" if np.isfinite(value) else "computed"}
        curve = [part.sel(hurst_exponent=value).transpose() for part in (x, means, errors)]
        style.errorbars(axes, *curve, **look)


def _plot_theory(axes: Sequence[Axes], pressure: Array, areas: Array, **look: Any) -> None:
    """Plot the area of a theory and its ratio to the reduced pressure."""
    for panel, values in zip(axes, (areas, areas / pressure), strict=True):
        panel.plot(pressure, values, lw=0.9, zorder=1, **look)


def _plot_densities(
    axes: Sequence[Axes], data: xr.Dataset, name: str, label: str, theories: Sequence[Theory]
) -> pd.DataFrame:
    """Plot densities, one panel a Hurst exponent and one colour a load, with theories; return them as a table."""
    means, errors = data[f"{name}_mean"], mean_error(data, name)
    for panel, hurst_exponent, theory in zip(axes, _exponents(data), theories, strict=True):
        _plot_density(panel, data.sel(hurst_exponent=hurst_exponent), name, theory)
        panel.set(yscale="log", ylim=(LEAST_DENSITY, None), xlabel=label, ylabel="density")
        panel.set_title(f"$H={hurst_exponent:g}$", fontsize=9)
    _end_where_all_is_zero(axes, means)
    style.share_vertical_range(list(axes))
    style.add_letters(list(axes))
    table = xr.Dataset({name: means, f"{name}_error": errors}).to_dataframe().reset_index()
    return table[table[name] > 0]


def _plot_density(axes: Axes, data: xr.Dataset, name: str, theory: Theory) -> None:
    """Plot a density with its error and that of a theory, one colour a load."""
    means, errors = data[f"{name}_mean"], mean_error(data, name)
    x = _bins(means)
    for pressure, colour in style.shades(data.reduced_pressure.values).items():
        mean, error = (part.sel(reduced_pressure=pressure, method="nearest").values for part in (means, errors))
        label = _load_label(pressure)
        axes.plot(x, np.where(mean > 0, mean, np.nan), color=colour, lw=1.1, label=label)
        seen = mean > error  # a band down to zero would hide others on a logarithmic axis
        band: dict[str, Any] = {"color": colour, "alpha": SHADE, "lw": 0, "label": f"{label} with its error"}
        axes.fill_between(x, mean - error, mean + error, where=seen, **band)
        axes.plot(x, theory(x, pressure), color=colour, lw=0.9, ls=PERSSON, label=f"{label}, Persson")


def _bins(densities: xr.DataArray) -> Array:
    """Return the middle of each bin of densities."""
    return densities[next(dim for dim in densities.dims if str(dim).endswith("_bin"))].values


def _end_where_all_is_zero(axes: Sequence[Axes], means: xr.DataArray) -> None:
    """End the horizontal axes at the last bin of which a density is drawn."""
    others = [dim for dim in means.dims if not str(dim).endswith("_bin")]
    seen = np.flatnonzero(means.max(others).values > LEAST_DENSITY)
    for panel in axes:
        panel.set_xlim(0, _bins(means)[seen[-1]] * LEGEND_ROOM if seen.size else None)


def _load_handles(data: xr.Dataset) -> list[Line2D]:
    """Return legend handles of the loads in their colours."""
    colours = style.shades(data.reduced_pressure.values)
    return style.colour_handles({_load_label(pressure): colour for pressure, colour in colours.items()})


def _load_label(pressure: float) -> str:
    """Return the label of a load."""
    return f"$p^*={pressure:.3g}$"
