"""Chapter 5: rough contact of compressible bodies. Each function draws one figure and returns the numbers it shows.

Values of the thesis, from `reference` in the config, come as keywords.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim.ensemble import relative_change
from contactsim.figures import rough_curves as rough
from contactsim.figures import style

AVERAGES = ("relative_contact_area", "kappa_r", "kappa_r_bond", "reduced_pressure_contact")
LINES = ("-", ":", "-.", "--")
"""Lines of thicknesses, the largest first."""
FAINT = 0.35
WALL_LOOK = {"color": style.EXACT, "ls": "--", "lw": 1.0, "marker": "x"}
INTERFACE, SHOWN = 20.0, 0.12
"""Approach (nm) beyond first touch of the pictures of the interface, and the part of the period that they show."""
SHADES = {"kappa_r": 1.0, "relative_contact_area": FAINT}
"""Opacity of the changes drawn; the grid errors over pairs are as faint as those of the area."""


def fig_5_2(data: xr.Dataset, axes: list[Axes], *, kappa_r: float) -> pd.DataFrame:
    """Area, κ_r, what the layer changes and the grid error, for H, Poisson's ratio and thickness (thesis Fig. 5.2).

    The thickest body is what the others are held against, and the one whose κ_r is drawn over pairs of neighbours in
    contact too. kappa_r: the thesis's constant.
    """
    area, factor, change, last = axes
    thickest = float(data.thickness.max())
    for name in SHADES:
        data = data.merge(relative_change(data, name, "thickness", thickest))
    for hurst, ratio, thickness in product(data.hurst.values, data.poisson_ratio.values, data.thickness.values):
        one = data.sel(hurst=hurst, poisson_ratio=ratio, thickness=thickness)
        look = style.poisson(ratio) | {"color": style.hurst_colour(hurst), "linewidth": 0.9}
        look["linestyle"] = _line(data, thickness)
        pressure = one.reduced_pressure_contact_mean
        style.with_errors(area, pressure, one, "relative_contact_area", **look)
        style.with_errors(factor, pressure, one, "kappa_r", **look)
        if thickness == thickest:
            style.with_errors(factor, pressure, one, "kappa_r_bond", **look, alpha=FAINT)
        style.grid_error(last, pressure, one, "kappa_r", **look)
        style.grid_error(last, pressure, one, "kappa_r_bond", **look, alpha=FAINT)
        if thickness < thickest:
            for name, alpha in SHADES.items():
                moved, error = one[f"{name}_change"], one[f"{name}_change_standard_error"]
                style.bars(change, one.reduced_pressure, moved, error, **look, alpha=alpha)
    dense = np.array([float(data.reduced_pressure_contact_mean.min()), float(data.reduced_pressure_contact_mean.max())])
    area.plot(dense, kappa_r * dense, color=style.EXACT, lw=0.8, ls=(0, (6, 3)))
    factor.axhline(kappa_r, color=style.EXACT, lw=0.8, ls=(0, (6, 3)))
    change.axhline(0.0, color=style.EXACT, lw=0.6)
    _frame(data, axes, kappa_r)
    return style.averages(data, AVERAGES)


def fig_5_3(data: xr.Dataset, wall: xr.Dataset, axes: list[Axes], *, kappa_r: float) -> pd.DataFrame:
    """Area against reduced pressure for works of separation, with the hard wall (thesis Fig. 5.3).

    kappa_r: the thesis's constant without adhesion.
    """
    data, wall, rows = rough.prepared(data), rough.prepared(wall), []
    for panel in axes:
        for work, color in rough.works(data).items():
            one = data.sel(work_of_separation=work)
            words = rough.work_words(data, work)
            name = "relative_interacting_area"
            rows.append(rough.curve(panel, one, rough.reduced(one), name, words, color=color, lw=1.0))
        rough.curve(panel, wall, rough.reduced(wall), "relative_interacting_area", "hard wall", **WALL_LOOK)
        dense = np.array([0.0, 2.0])
        panel.plot(dense, kappa_r * dense, color=style.EXACT, lw=0.8, ls=(0, (6, 3)), label=f"thesis, {kappa_r:g}")
        panel.set(xlabel=r"reduced pressure $p_r^*$", ylabel=rough.LABELS["relative_interacting_area"])
    axes[0].set(xlim=(-0.015, 0.06), ylim=(0, 1.02))
    axes[1].set(xlim=(-0.004, 0.012), ylim=(0, 0.5))
    axes[0].legend(loc="lower right")
    _letters(axes)
    return pd.concat(rows[: len(rows) // 2])


def fig_5_4(data: xr.Dataset, wall: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Pressure, gradient in contact and area against approach (thesis Fig. 5.4)."""
    data, wall, rows = rough.prepared(data), rough.prepared(wall), []
    names = ("normalised_pressure", "gradient_ratio_interacting", "relative_interacting_area")
    for panel, name in zip(axes, names, strict=True):
        for work, color in rough.works(data).items():
            one = data.sel(work_of_separation=work)
            words = rough.work_words(data, work)
            rows.append(rough.curve(panel, one, one.indentation, name, words, color=color, lw=1.0))
        rough.curve(panel, wall, wall.indentation, name, "hard wall", **WALL_LOOK)
        panel.set(xlabel=rough.LABELS["indentation"], ylabel=rough.LABELS[name], xlim=(-7, 24.5))
    axes[0].set_yscale("symlog", linthresh=1e-3)
    axes[1].set_ylim(0, 1.4)
    axes[2].legend(loc="upper left")
    _letters(axes)
    return pd.concat(rows[: len(rows) // 3])


def fig_5_5(data: xr.Dataset, wall: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """The interface at an approach with the strongest adhesion and with a hard wall (thesis Fig. 5.5)."""
    place, part = INTERFACE, slice(None)
    strong = data.sel(work_of_separation=data.work_of_separation.max())
    looks = {"color": style.PAIRS, "label": rough.work_words(data, float(strong.work_of_separation))}
    shown = rough.interface(axes, strong, place, looks, _window(strong))
    part = _window(strong)
    gap = wall.isel(member=0, step=-1).gap.values
    rigid = -wall.isel(member=0).heights.values - float(wall.isel(member=0).approach_first_touch) - place
    x = np.arange(gap.size) * float(wall.length) / gap.size
    axes.plot(x[part], (rigid - gap)[part], color=style.CONTACT, lw=0.9, label="hard wall")
    axes.set(xlabel="$x$ (nm)", ylabel="$z$ (nm)")
    axes.legend(loc="upper left")
    return shown.assign(wall=(rigid - gap)[part])


def fig_5_6(
    data: xr.Dataset, middle: xr.Dataset, high: xr.Dataset, hurst: xr.Dataset, axes: list[Axes]
) -> pd.DataFrame:
    """Area against pressure for rms heights and Hurst exponents (thesis Fig. 5.6)."""
    strong = data.sel(work_of_separation=data.work_of_separation.max())
    heights = {10.0: strong, 15.0: middle, 30.0: high}
    exponents = {float(value): hurst.sel(hurst=value) for value in hurst.hurst.values} | {0.8: strong}
    rows = []
    for panel, cases, symbol, unit in (
        (axes[0], heights, r"h_{\mathrm{rms}}", " nm"),
        (axes[1], exponents, "H", ""),
    ):
        for (value, one), color in zip(cases.items(), style.shades(cases).values(), strict=True):
            one = rough.prepared(one)
            rows.append(_against_pressure(panel, one, f"${symbol}={value:g}${unit}", color=color))
        _pressures(panel)
    _letters(axes)
    return pd.concat(rows)


def fig_5_7(
    data: xr.Dataset,
    hurst: xr.Dataset,
    coarse: xr.Dataset,
    coarsest: xr.Dataset,
    axes: list[Axes],
) -> pd.DataFrame:
    """Area against pressure with fewer and fewer short waves, and the interface (thesis Fig. 5.7)."""
    strong = data.sel(work_of_separation=data.work_of_separation.max())
    rows = []
    for value, whole in ((0.8, strong), (0.2, hurst.sel(hurst=0.2))):
        cases = {512: whole, 128: coarse.sel(hurst=value), 64: coarsest.sel(hurst=value)}
        for (count, one), line in zip(cases.items(), ("-", "--", ":"), strict=True):
            words = rf"$H={value:g}$, $\epsilon_f=1/{count}$"
            look = {"color": style.hurst_colour(value), "ls": line, "marker": style.HURST[value][0]}
            rows.append(_against_pressure(axes[0], rough.prepared(one), words, **look))
    _pressures(axes[0])
    pictures = ((axes[1], 0.8, strong), (axes[2], 0.2, hurst.sel(hurst=0.2)))
    for panel, value, whole in pictures:
        for one, count, color in ((whole, 512, style.CONTACT), (coarsest.sel(hurst=value), 64, style.WHOLE)):
            looks = {"color": color, "label": rf"$\epsilon_f=1/{count}$"}
            rough.interface(panel, one, INTERFACE, looks, _window(one))
        panel.set(xlabel="$x$ (nm)", ylabel="$z$ (nm)", title=f"$H={value:g}$")
        panel.legend(loc="upper left")
    _letters(axes)
    return pd.concat(rows)


def fig_5_8(data: xr.Dataset, normal: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Area against pressure by the coupled law for Poisson's ratios and friction (thesis Fig. 5.8)."""
    rows = []
    cases = list(product(data.poisson_ratio.values, data.work_ratio.values))
    colours = style.shades(data.poisson_ratio.values)
    for ratio, work in cases:
        one = rough.prepared(data.sel(poisson_ratio=ratio, work_ratio=work))
        words = rf"$\nu={ratio:g}$, $c={work:g}$"
        look = {"color": colours[float(ratio)], "ls": "-" if work else "--", "marker": "s" if work else "o"}
        rows.append(_against_pressure(axes[0], one, words, **look))
        rough.curve(axes[1], one, one.indentation, "relative_interacting_area", words, lw=1.0, **look)
    strong = rough.prepared(normal.sel(work_of_separation=normal.work_of_separation.max()))
    rows.append(_against_pressure(axes[0], strong, "uncoupled", color=style.EXACT, ls=":", marker="."))
    _pressures(axes[0])
    axes[1].set(xlabel=rough.LABELS["indentation"], ylabel=rough.LABELS["relative_interacting_area"])
    _letters(axes)
    return pd.concat(rows)


def _against_pressure(panel: Axes, one: xr.Dataset, words: str, **look: object) -> pd.DataFrame:
    return rough.curve(panel, one, one.normalised_pressure_mean, "relative_interacting_area", words, lw=1.0, **look)


def _pressures(panel: Axes) -> None:
    """Area against pressure, as far as the contact is not yet whole."""
    panel.set(xlabel=rough.LABELS["normalised_pressure"], ylabel=rough.LABELS["relative_interacting_area"])
    panel.set(xlim=(-0.006, 0.03), ylim=(0, 1.02))
    panel.legend(loc="lower right", fontsize=6.5)


def _window(one: xr.Dataset) -> slice:
    """The part of the period about the highest point, which touches first."""
    heights = one.heights.isel(member=0).values
    width = int(heights.size * SHOWN)
    middle = int(np.clip(np.argmax(heights), width // 2, heights.size - width // 2))
    return slice(middle - width // 2, middle + width // 2)


def _letters(axes: list[Axes]) -> None:
    for panel, letter in zip(axes, "abcd", strict=False):
        style.letter(panel, letter)


def _line(data: xr.Dataset, thickness: float) -> str:
    """Line style of a thickness."""
    place = list(np.sort(data.thickness.values)[::-1]).index(thickness)
    return LINES[min(place, len(LINES) - 1)]


def _frame(data: xr.Dataset, axes: list[Axes], kappa_r: float) -> None:
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
    change.legend(handles=_shades({style.SYMBOLS[name]: alpha for name, alpha in SHADES.items()}), loc="lower right")
    factor.legend(handles=_shades({"Eq. 3.8": 1.0, "pairs in contact": FAINT}), loc="upper right")
    last.legend(handles=_shades({"Eq. 3.8": 1.0, "pairs in contact": FAINT}), loc="lower left")


def _shades(names: dict[str, float]) -> list[Line2D]:
    return [Line2D([], [], color=style.EXACT, alpha=alpha, lw=1.5, label=name) for name, alpha in names.items()]


def _power(value: float) -> str:
    """A number as it is, a large one as a power of ten."""
    return f"{value:g}" if value < 1e5 else f"10^{{{np.log10(value):.3g}}}"
