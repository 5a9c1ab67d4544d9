"""Chapter 3: contact without adhesion. Each function plots one figure and returns the numbers that it shows.

Keyword arguments are values of the thesis, from `reference` in the config.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim import reference
from contactsim.analysis import ensemble
from contactsim.analysis.resolution import ratio_table
from contactsim.analysis.round_contact import KAPPA_R, beside_exact
from contactsim.figures import style
from contactsim.figures.maps import SurfaceFields, plot_fields
from contactsim.figures.parts import proportionality, resolution
from contactsim.variables import find_variable

FREE_OF_NEIGHBOURS = 0.25
"""Largest c/R at which a cylinder or sphere at L/R = 4 does not feel its neighbours."""
ROUND_LABELS = {
    "cylinder": r"cylinder, exact $8/(\pi\sqrt{3})$ = 1.470",
    "sphere": r"sphere, exact $3\pi/(4\sqrt{2})$ = 1.666",
}
ROUND_LOOKS = {"cylinder": ("o", "+", "-"), "sphere": ("s", "x", "--")}
"""Markers of κ_r by Eq. 3.8 and over pairs, and line of the exact value."""
TABLE_HEADS = {
    "contact_ratio": r"$c/R$",
    "area_exact": "$a_{act}$\nexact",
    "area": "$a_{act}$\ncomputed",
    "load": "$L$\ngiven",
    "rms_gradient_exact": r"$\bar g_r$" + "\nexact",
    "rms_gradient_contact": r"$\bar g_r$" + "\ncomputed",
    "kappa_r_exact": r"$\kappa_r$" + "\nexact",
    "kappa_r": r"$\kappa_r$" + "\ncomputed",
    "kappa_r_pairs": r"$\kappa_r$" + "\nof pairs",
}
AVERAGES = ("relative_contact_area", "kappa", "kappa_r", "kappa_r_pairs")
BOTH_PRESSURES = r"reduced pressure $p^*$, $p_r^*$"


def fig_3_1(line: xr.Dataset, surface: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Plot κ_r of a cylinder and of a sphere against the load, of which it does not depend (thesis Fig. 3.1)."""
    handles, tables = [], []
    for data, name in ((line, "cylinder"), (surface, "sphere")):
        body = beside_exact(data, name)
        marker, _, exact_line = ROUND_LOOKS[name]
        _plot_kappa_r(axes, body.sel(contact_ratio=slice(None, FREE_OF_NEIGHBOURS)), name, 1.0)
        _plot_kappa_r(axes, body.isel(contact_ratio=body.contact_ratio.values > FREE_OF_NEIGHBOURS), name, style.FAINT)
        exact = axes.axhline(KAPPA_R[name], color=style.EXACT, lw=1, ls=exact_line, label=ROUND_LABELS[name])
        handles += [exact, Line2D([], [], ls="", label=name, **style.marker_look(style.GREY, marker))]
        tables.append(body.to_dataframe().reset_index().assign(body=name))
    axes.set(xscale="log", ylim=(1.2, 2.2))
    axes.set(xlabel=r"reduced pressure $p_r^*$", ylabel=r"$\kappa_r$")
    colours = style.colour_handles({"Eq. 3.8": style.CONTACT, "pairs in contact": style.PAIRS})
    axes.legend(handles=[*handles, *colours], loc="upper left", ncols=2)
    return pd.concat(tables)[["body", *TABLE_HEADS]]


def _plot_kappa_r(axes: Axes, body: xr.Dataset, name: str, alpha: float) -> None:
    """Plot κ_r by Eq. 3.8 with its grid error, and κ_r over pairs, of a cylinder or sphere."""
    marker, pair_marker, _ = ROUND_LOOKS[name]
    pressure, look = body.reduced_pressure_contact, {"fmt": marker, "ms": 4, "mfc": "white", "elinewidth": 0.7}
    axes.errorbar(pressure, body.kappa_r, body.get("kappa_r_grid_error"), color=style.CONTACT, alpha=alpha, **look)
    axes.plot(pressure, body.kappa_r_pairs, pair_marker, color=style.PAIRS, ms=5, alpha=alpha)


def table_3_1(line: xr.Dataset, surface: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Draw the table of a cylinder's and a sphere's contact, exact and computed (thesis Table 3.1)."""
    bodies = {name: beside_exact(data, name) for data, name in ((line, "cylinder"), (surface, "sphere"))}
    tables = [body.to_dataframe().reset_index().assign(body=name) for name, body in bodies.items()]
    table = pd.concat(tables)[["body", *TABLE_HEADS]]
    text = [[row[0], *(f"{value:#.4g}" for value in row[1:])] for row in table.to_numpy()]
    style.draw_table(axes, ["", *TABLE_HEADS.values()], text)
    return table


def fig_3_2(data: xr.Dataset, axes: list[Axes], *, kappa_r: float) -> pd.DataFrame:
    """Plot the area of lines against both reduced pressures, and the factors of proportionality (thesis Fig. 3.2)."""
    area, both, contact, error = axes
    proportionality.plot_areas(area, data)
    proportionality.plot_factors(both, data, ("kappa", "kappa_r"))
    proportionality.plot_factors(contact, data, ("kappa_r", "kappa_r_pairs"))
    proportionality.plot_grid_errors(error, data, ("kappa_r", "kappa_r_pairs"))
    proportionality.plot_persson(area, both, data)
    for panel in (both, contact):
        panel.axhline(kappa_r, color=style.EXACT, lw=0.8, ls=style.THESIS)
    both.set(ylabel=r"$\kappa^{1D}$, $\kappa_r^{1D}$")
    contact.set(ylabel=r"$\kappa_r^{1D}$")
    style.include_range(contact, kappa_r - 0.15, kappa_r + 0.05)
    error.set(ylabel=r"grid error of $\kappa_r^{1D}$")
    for panel in axes:
        contact_alone = r"reduced pressure $p_r^*$"
        panel.set(xscale="log", xlabel=BOTH_PRESSURES if panel in (area, both) else contact_alone)
    style.add_letters(axes)
    area.legend(handles=style.hurst_handles(data.hurst_exponent.values), loc="upper left")
    lines = {f"thesis, {kappa_r:g}": style.THESIS, r"Persson (2D), erf$(\sqrt{2}p^*)$": "-"}
    both.legend(handles=_gradient_handles(lines), loc="upper right")
    both.set_ylim(top=both.get_ylim()[1] * 1.25)
    contact.text(0.03, 0.03, proportionality.constancy_text(data), transform=contact.transAxes, fontsize=6, va="bottom")
    return style.mean_table(data, AVERAGES)


def fig_3_4(data: xr.Dataset, axes: list[Axes], *, kappa: float, kappa_r: float) -> pd.DataFrame:
    """Plot the area of surfaces against both reduced pressures, and the factors (thesis Fig. 3.4)."""
    area, factor, error = axes
    names = ("kappa", "kappa_r", "kappa_r_pairs")
    proportionality.plot_areas(area, data)
    proportionality.plot_factors(factor, data, names)
    proportionality.plot_grid_errors(error, data, names)
    proportionality.plot_persson(area, factor, data)
    for value, colour in ((kappa, style.WHOLE), (kappa_r, style.CONTACT)):
        factor.axhline(value, color=colour, lw=0.8, ls=style.THESIS)
    factor.set(ylabel=r"$\kappa^{2D}$, $\kappa_r^{2D}$")
    error.set(ylabel=r"grid error of $\kappa^{2D}$, $\kappa_r^{2D}$")
    for panel in axes:
        panel.set(xscale="log", xlabel=BOTH_PRESSURES)
    style.add_letters(axes)
    area.legend(handles=style.hurst_handles(data.hurst_exponent.values), loc="upper left")
    lines = {rf"thesis, {kappa:g} and {kappa_r:g}": style.THESIS, r"Persson, erf$(\sqrt{2}p^*)$": "-"}
    factor.legend(handles=_gradient_handles(lines), loc="best")
    style.add_headroom(factor, 0.45)
    return style.mean_table(data, AVERAGES)


def _gradient_handles(lines: dict[str, object]) -> list[Line2D]:
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
    coarse: xr.Dataset,
    surface: xr.Dataset,
    lines_finer: xr.Dataset,
    surfaces_finer: xr.Dataset,
    axes: list[Axes],
    *,
    ratio: float,
) -> pd.DataFrame:
    """Plot the factors of lines over those of surfaces (thesis Fig. 3.5); ratio: the thesis's, of κ_r."""
    tables = [
        _plot_ratios(panel, lines, surface).assign(grid=name)
        for panel, lines, name in zip(axes[:2], (coarse, line), ("equal", "own"), strict=True)
    ]
    tables.append(ratio_table(lines_finer, surfaces_finer))
    resolution.plot_ratio_limits(tables[-1], axes[2])
    for panel in axes:
        panel.axhline(ratio, color=style.EXACT, lw=0.8, ls=style.THESIS)
        panel.axhline(reference.CYLINDER_KAPPA_R / reference.SPHERE_KAPPA_R, color=style.EXACT, lw=0.8)
        panel.set(xscale="log", xlabel=r"reduced pressure $p^*$", ylabel=r"$\kappa^{1D}/\kappa^{2D}$")
    style.add_letters(axes)
    names = {"over the whole surface": "kappa", "over the contact": "kappa_r", "over pairs": "kappa_r_pairs"}
    colours = {label: proportionality.FACTOR_COLOURS[name] for label, name in names.items()}
    handles = style.hurst_handles(surface.hurst_exponent.values) + style.colour_handles(colours)
    axes[0].legend(handles=handles, loc="upper right", ncols=2)
    style.add_headroom(axes[0], 0.3)
    return pd.concat(tables)[["grid", "quantity", "hurst_exponent", "reduced_pressure", "value", "error", "spread"]]


def _plot_ratios(axes: Axes, lines: xr.Dataset, surface: xr.Dataset) -> pd.DataFrame:
    """Plot the factors of lines over those of surfaces at the loads that both have."""
    tables = []
    loads = np.intersect1d(lines.reduced_pressure, surface.reduced_pressure)
    for hurst_exponent in surface.hurst_exponent.values:
        ensembles = [data.sel(reduced_pressure=loads, hurst_exponent=hurst_exponent) for data in (lines, surface)]
        for name, colour in proportionality.FACTOR_COLOURS.items():
            ratios = ensemble.ratio_of_means(*ensembles, name)
            look = style.hurst_look(hurst_exponent) | {"color": colour}
            style.errorbars(axes, ratios.reduced_pressure, ratios.value, ratios.error, **look)
            tables.append(ratios.to_dataframe().reset_index().assign(quantity=name, hurst_exponent=hurst_exponent))
    return pd.concat(tables)


def maps(fields: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Map contact, pressure and gap of one rough surface at one load."""
    surface_fields = SurfaceFields.of_dataset(fields)
    places = {dim: fields[dim].item() for dim in fields.status.dims if dim != "member"}
    labels = [f"{find_variable(dim).symbol or dim} = {value:g}" for dim, value in places.items()]
    axes[0].text(1, -0.03, ", ".join(labels), transform=axes[0].transAxes, fontsize=8, ha="right", va="top")
    return plot_fields(surface_fields, axes).assign(**places)


def fig_3_3(data: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Plot the fits of Eq. 3.11 to each Hurst exponent and to all (thesis Fig. 3.3).

    Returns the constants of every fit, and κ of it at each load of the data.
    """
    _plot_fits(axes, data)
    for hurst_exponent in data.hurst_exponent.values:
        means, look = (
            data.sel(hurst_exponent=hurst_exponent),
            style.hurst_look(hurst_exponent) | {"linestyle": "none", "color": "#888888"},
        )
        style.plot_means(axes, means.reduced_pressure, means, "kappa", **look)
    pressure, persson = proportionality.persson_curve(data, 200)
    axes.plot(pressure, persson / pressure, color=style.EXACT, lw=0.8, ls="-.")
    axes.set(xscale="log", xlabel=r"reduced pressure $p^*$", ylabel=r"$\kappa^{1D}_{\mathrm{fit}}$")
    axes.set_ylim(top=axes.get_ylim()[1] * 1.22)
    labels = {"fit to all $H$, of the area": ("all", "area"), "of its logarithm": ("all", "logarithm")}
    labels |= {"fit to one $H$, of the area": ("one", "area"), "of its logarithm ": ("one", "logarithm")}
    fits = [Line2D([], [], label=label, **proportionality.fit_look(*fit)) for label, fit in labels.items()]
    handles = style.hurst_handles(data.hurst_exponent.values) + style.line_handles({"Persson (2D)": "-."}) + fits
    axes.legend(handles=handles, ncols=2, loc="upper right")
    names = [name for name in data.data_vars if str(name).startswith("fit_")]
    kappa = xr.apply_ufunc(proportionality.fitted_kappa, data.reduced_pressure, data.fit_b1, data.fit_b2)
    order = [*data.fit_b1.dims, "reduced_pressure"]
    return data[names].assign(kappa_fit=kappa).to_dataframe(dim_order=order).reset_index()


def _plot_fits(axes: Axes, data: xr.Dataset) -> None:
    """Plot κ of the fits up to the smallest limit of pressure."""
    pressure, _ = proportionality.persson_curve(data, 200)
    lowest = data.sel(fit_limit=float(data.fit_limit.min()))
    for weighting in proportionality.FIT_LINES:
        for name in data.fitted.values:
            fit = lowest.sel(weighting=weighting, fitted=name)
            kappa = proportionality.fitted_kappa(pressure, fit.fit_b1.item(), fit.fit_b2.item())
            axes.plot(pressure, kappa, **proportionality.fit_look(name, weighting))
