"""Chapter 3: contact without adhesion. Each function draws one figure and returns the numbers that it shows.

Values of the thesis, from `reference` in the config, come as keywords.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim import notation, reference
from contactsim.analysis import ensemble
from contactsim.figures import style
from contactsim.figures.maps import of_dataset, panels
from contactsim.figures.parts import factors, resolution

FREE_OF_NEIGHBOURS = 0.25
"""Largest c/R at which a cylinder or sphere at L/R = 4 does not feel its neighbours."""
TABLE = {
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


def fig_3_1(line: xr.Dataset, surface: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """κ_r of a cylinder and of a sphere do not depend on the load (thesis Fig. 3.1)."""
    shown, rows = [], []
    for data, name, mark in ((line, "cylinder", "o"), (surface, "sphere", "s")):
        exact, words = factors.ROUND[name]
        one = factors.round_body(data, exact)
        pressure, look = one.reduced_pressure_contact, {"fmt": mark, "ms": 4, "mfc": "white", "elinewidth": 0.7}
        for part, fade in (
            (one.contact_ratio <= FREE_OF_NEIGHBOURS, 1.0),
            (one.contact_ratio > FREE_OF_NEIGHBOURS, 0.35),
        ):
            x = pressure[part]
            bars = one.kappa_r_grid_error[part] if "kappa_r_grid_error" in one else None
            axes.errorbar(x, one.kappa_r[part], bars, color=style.CONTACT, alpha=fade, **look)
            axes.plot(x, one.kappa_r_pairs[part], "+" if mark == "o" else "x", color=style.PAIRS, ms=5, alpha=fade)
        shown.append(axes.axhline(exact, color=style.EXACT, lw=1, ls="-" if mark == "o" else "--", label=words))
        shown.append(Line2D([], [], color="#777777", ls="", marker=mark, mfc="white", ms=4, label=name))
        rows.append(one.to_dataframe().reset_index().assign(body=name))
    axes.set(xscale="log", ylim=(1.2, 2.2))
    axes.set(xlabel=r"reduced pressure $p_r^*$", ylabel=r"$\kappa_r$")
    colours = {"Eq. 3.8": style.CONTACT, "pairs in contact": style.PAIRS}
    axes.legend(handles=[*shown, *style.key(colours, {})], loc="upper left", ncols=2)
    return pd.concat(rows)[["body", *list(TABLE)]]


def table_3_1(line: xr.Dataset, surface: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Cylinder and sphere: area, load, gradient in contact and κ_r, exact and computed (thesis Table 3.1)."""
    parts = []
    for data, name in ((line, "cylinder"), (surface, "sphere")):
        one = factors.round_body(data, factors.ROUND[name][0])
        parts.append(one.to_dataframe().reset_index()[list(TABLE)].assign(body=name))
    rows = pd.concat(parts)[["body", *TABLE]]
    text = [[row[0], *(f"{value:#.4g}" for value in row[1:])] for row in rows.to_numpy()]
    style.table(axes, ["", *TABLE.values()], text)
    return rows


AVERAGES = ("relative_contact_area", "kappa", "kappa_r", "kappa_r_pairs")


def fig_3_2(data: xr.Dataset, axes: list[Axes], *, kappa_r: float) -> pd.DataFrame:
    """Area against both reduced pressures, and the proportionality factors (thesis Fig. 3.2).

    kappa_r: the thesis's constant.
    """
    left, middle, right, last = axes
    for value in data.hurst.values:
        one, look = data.sel(hurst=value), style.hurst(value)
        whole, contact = one.reduced_pressure, one.reduced_pressure_contact_mean
        style.with_errors(left, whole, one, "relative_contact_area", color=style.WHOLE, **look)
        style.with_errors(left, contact, one, "relative_contact_area", color=style.CONTACT, **look)
        style.with_errors(middle, whole, one, "kappa", color=style.WHOLE, **look)
        for panel in (middle, right):
            style.with_errors(panel, contact, one, "kappa_r", color=style.CONTACT, **look)
        style.with_errors(right, contact, one, "kappa_r_pairs", color=style.PAIRS, **look)
        style.grid_error(last, contact, one, "kappa_r", color=style.CONTACT, **look)
        style.grid_error(last, contact, one, "kappa_r_pairs", color=style.PAIRS, **look)
    dense = np.geomspace(*data.reduced_pressure.values[[0, -1]], 100)
    persson = reference.persson_area(dense)
    left.plot(dense, persson, color=style.EXACT, lw=0.8)
    middle.plot(dense, persson / dense, color=style.EXACT, lw=0.8)
    for panel in (middle, right):
        panel.axhline(kappa_r, color=style.EXACT, lw=0.8, ls=(0, (6, 3)))
    left.set(yscale="log", ylabel=r"relative contact area $a_{\mathrm{rel}}$")
    middle.set(ylabel=r"$\kappa^{1D}$, $\kappa_r^{1D}$")
    right.set(ylabel=r"$\kappa_r^{1D}$")
    style.keep_in_view(right, kappa_r - 0.15, kappa_r + 0.05)
    last.set(yscale="log", ylabel=r"grid error of $\kappa_r^{1D}$")
    for panel, letter in zip(axes, "abcd", strict=True):
        both = panel in (left, middle)
        panel.set(xscale="log", xlabel="reduced pressure " + (r"$p^*$, $p_r^*$" if both else r"$p_r^*$"))
        style.letter(panel, letter)
    left.legend(handles=style.hurst_key(data.hurst.values), loc="upper left")
    colours = {r"$\bar g$ over the whole surface": style.WHOLE, r"$\bar g_r$ over the contact (Eq. 3.8)": style.CONTACT}
    lines = {f"thesis, {kappa_r:g}": (0, (6, 3)), r"Persson (2D), erf$(\sqrt{2}p^*)$": "-"}
    middle.legend(
        handles=style.key(colours | {r"$\bar g_r$ over pairs in contact": style.PAIRS}, lines), loc="upper right"
    )
    middle.set_ylim(top=middle.get_ylim()[1] * 1.25)
    right.text(0.03, 0.03, factors.constancy(data), transform=right.transAxes, fontsize=6, va="bottom")
    return style.averages(data, AVERAGES)


def fig_3_4(data: xr.Dataset, axes: list[Axes], *, kappa: float, kappa_r: float) -> pd.DataFrame:
    """Area of surfaces against both reduced pressures, and the proportionality factors (thesis Fig. 3.4).

    kappa, kappa_r: the thesis's values.
    """
    left, middle, right = axes
    for value in data.hurst.values:
        one, look = data.sel(hurst=value), style.hurst(value)
        whole, contact = one.reduced_pressure, one.reduced_pressure_contact_mean
        style.with_errors(left, whole, one, "relative_contact_area", color=style.WHOLE, **look)
        style.with_errors(left, contact, one, "relative_contact_area", color=style.CONTACT, **look)
        for x, name, color in (
            (whole, "kappa", style.WHOLE),
            (contact, "kappa_r", style.CONTACT),
            (contact, "kappa_r_pairs", style.PAIRS),
        ):
            style.with_errors(middle, x, one, name, color=color, **look)
            style.grid_error(right, x, one, name, color=color, **look)
    dense = np.geomspace(*data.reduced_pressure.values[[0, -1]], 100)
    persson = reference.persson_area(dense)
    left.plot(dense, persson, color=style.EXACT, lw=0.8)
    middle.plot(dense, persson / dense, color=style.EXACT, lw=0.8)
    for value, color in ((kappa, style.WHOLE), (kappa_r, style.CONTACT)):
        middle.axhline(value, color=color, lw=0.8, ls=(0, (6, 3)))
    left.set(yscale="log", ylabel=r"relative contact area $a_{\mathrm{rel}}$")
    middle.set(ylabel=r"$\kappa^{2D}$, $\kappa_r^{2D}$")
    right.set(yscale="log", ylabel=r"grid error of $\kappa^{2D}$, $\kappa_r^{2D}$")
    for panel, letter in zip(axes, "abc", strict=True):
        panel.set(xscale="log", xlabel=r"reduced pressure $p^*$, $p_r^*$")
        style.letter(panel, letter)
    left.legend(handles=style.hurst_key(data.hurst.values), loc="upper left")
    colours = {r"$\bar g$ over the whole surface": style.WHOLE, r"$\bar g_r$ over the contact (Eq. 3.8)": style.CONTACT}
    lines = {rf"thesis, {kappa:g} and {kappa_r:g}": (0, (6, 3)), r"Persson, erf$(\sqrt{2}p^*)$": "-"}
    middle.legend(handles=style.key(colours | {r"$\bar g_r$ over pairs in contact": style.PAIRS}, lines), loc="best")
    middle.set_ylim(top=middle.get_ylim()[1] + 0.45 * np.ptp(middle.get_ylim()))
    return style.averages(data, AVERAGES)


def fig_3_2_grid(data: xr.Dataset, finer: xr.Dataset, axes: list[Axes], *, kappa_r: float) -> pd.DataFrame:
    """Proportionality factors of lines on finer and finer grids; kappa_r: the thesis's constant."""
    return resolution.grids(data, finer, axes, {"kappa_r": kappa_r})


def fig_3_4_grid(
    data: xr.Dataset, finer: xr.Dataset, axes: list[Axes], *, kappa: float, kappa_r: float
) -> pd.DataFrame:
    """Proportionality factors of surfaces on finer and finer grids; kappa, kappa_r: the thesis's values."""
    return resolution.grids(data, finer, axes, {"kappa": kappa, "kappa_r": kappa_r})


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
    """Proportionality factors of lines over those of surfaces (thesis Fig. 3.5); ratio: the thesis's, of κ_r."""
    rows = []
    smooth = reference.CYLINDER_KAPPA_R / reference.SPHERE_KAPPA_R
    colours = resolution.QUANTITIES
    for panel, lines, name in zip(axes[:2], (coarse, line), ("equal", "own"), strict=True):
        loads = np.intersect1d(lines.reduced_pressure, surface.reduced_pressure)
        for value in surface.hurst.values:
            one, two = (data.sel(reduced_pressure=loads, hurst=value) for data in (lines, surface))
            for quantity, color in colours.items():
                found = ensemble.ratio_of_means(one, two, quantity)
                bars = found.error if np.isfinite(found.error).any() else None
                look = style.hurst(value) | {"color": color, "elinewidth": 0.8, "capsize": 1.5}
                panel.errorbar(found.reduced_pressure, found.value, bars, **look)
                rows.append(found.to_dataframe().reset_index().assign(quantity=quantity, hurst=value, grid=name))
    rows.append(resolution.ratios(lines_finer, surfaces_finer))
    resolution.draw_limits(rows[-1], axes[2])
    for panel in axes:
        panel.axhline(ratio, color=style.EXACT, lw=0.8, ls=(0, (6, 3)))
        panel.axhline(smooth, color=style.EXACT, lw=0.8)
        panel.set(xscale="log", xlabel=r"reduced pressure $p^*$", ylabel=r"$\kappa^{1D}/\kappa^{2D}$")
    style.letters(axes)
    names = {"over the whole surface": "kappa", "over the contact": "kappa_r", "over pairs": "kappa_r_pairs"}
    keys = {words: colours[quantity] for words, quantity in names.items()}
    axes[0].legend(handles=style.hurst_key(surface.hurst.values) + style.key(keys, {}), loc="upper right", ncols=2)
    axes[0].set_ylim(top=axes[0].get_ylim()[1] + 0.3 * np.ptp(axes[0].get_ylim()))
    return pd.concat(rows)[["grid", "quantity", "hurst", "reduced_pressure", "value", "error", "spread"]]


def maps(fields: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Contact, pressure and gap of one rough surface at one load."""
    one = of_dataset(fields)
    places = {dim: fields[dim].item() for dim in fields.status.dims if dim != "member"}
    words = [f"{notation.PLACES.get(dim, dim)} = {value:g}" for dim, value in places.items()]
    axes[0].text(1, -0.03, ", ".join(words), transform=axes[0].transAxes, fontsize=8, ha="right", va="top")
    return panels(one, axes).assign(**places)


def fig_3_3(data: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Eq. 3.11 fitted to each Hurst exponent and to all (thesis Fig. 3.3).

    Returns the constants of every fit, and κ of it at each load of the data.
    """
    dense = np.geomspace(*data.reduced_pressure.values[[0, -1]], 200)
    lowest = data.sel(fit_limit=float(data.fit_limit.min()))
    for weighting in factors.FIT_LOOKS:
        for name in data.fitted.values:
            fit = lowest.sel(weighting=weighting, fitted=name)
            fitted = factors.kappa_fit(dense, fit.fit_b1.item(), fit.fit_b2.item())
            axes.plot(dense, fitted, **factors.fit_look(name, weighting))
    for value in data.hurst.values:
        one, look = data.sel(hurst=value), style.hurst(value) | {"linestyle": "none"}
        style.with_errors(axes, one.reduced_pressure, one, "kappa", color="#888888", **look)
    axes.plot(dense, reference.persson_area(dense) / dense, color=style.EXACT, lw=0.8, ls="-.")
    axes.set(xscale="log", xlabel=r"reduced pressure $p^*$", ylabel=r"$\kappa^{1D}_{\mathrm{fit}}$")
    axes.set_ylim(top=axes.get_ylim()[1] * 1.22)
    lines = {"fit to all $H$, of the area": ("all", "area"), "of its logarithm": ("all", "logarithm")}
    lines |= {"fit to one $H$, of the area": ("one", "area"), "of its logarithm ": ("one", "logarithm")}
    keys = [Line2D([], [], label=label, **factors.fit_look(*fit)) for label, fit in lines.items()]
    last = style.key({}, {"Persson (2D)": "-."})
    axes.legend(handles=style.hurst_key(data.hurst.values) + last + keys, ncols=2, loc="upper right")
    names = [name for name in data.data_vars if str(name).startswith("fit_")]
    factor = xr.apply_ufunc(factors.kappa_fit, data.reduced_pressure, data.fit_b1, data.fit_b2)
    order = [*data.fit_b1.dims, "reduced_pressure"]
    return data[names].assign(kappa_fit=factor).to_dataframe(dim_order=order).reset_index()
