"""Chapter 5: rough contact of compressible bodies. Each function plots one figure and returns the numbers it shows.

Keyword arguments are values of the thesis, from `reference` in the config.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from contactsim.analysis.ensemble import relative_change
from contactsim.analysis.rough_paths import (
    Saving,
    with_indentation,
)
from contactsim.figures import style
from contactsim.figures.parts import interfaces, savings, thicknesses
from contactsim.figures.parts import rough_curves as rough

AVERAGES = ("relative_contact_area", "kappa_r", "kappa_r_pairs", "reduced_pressure_contact")
PICTURE, COVER_PICTURE, CLOSE_UP = 0.12, 0.3, 0.05
"""Parts of the period that pictures of the interface show."""
FIG_5_3_ENDS = 0.012, 0.003
"""Largest pressures over E* of the panels of Fig. 5.3."""


def fig_5_2(data: xr.Dataset, axes: list[Axes], *, kappa_r: float) -> pd.DataFrame:
    """Plot area, κ_r, their changes by the layer, and the grid error (thesis Fig. 5.2).

    Changes are from the thickest body; its κ_r is plotted over pairs of points in contact too.
    """
    area, factor, change, _ = axes
    thickest = float(data.thickness.max())
    for name in thicknesses.CHANGE_OPACITIES:
        data = data.merge(relative_change(data, name, "thickness", thickest))
    thicknesses.plot_bodies(data, axes)
    pressure = data.reduced_pressure_contact_mean
    ends = np.array([float(pressure.min()), float(pressure.max())])
    thesis = {"color": style.EXACT, "lw": 0.8, "ls": style.THESIS, "label": f"_thesis, {kappa_r:g}"}
    area.plot(ends, kappa_r * ends, **thesis)
    factor.axhline(kappa_r, **thesis)
    change.axhline(0.0, **style.ZERO)
    thicknesses.label_panels(data, axes, kappa_r)
    return style.mean_table(data, AVERAGES)


def fig_5_3(
    data: xr.Dataset, wall: xr.Dataset, repulsive: xr.Dataset, stiff: xr.Dataset, axes: list[Axes], *, kappa_r: float
) -> pd.DataFrame:
    """Plot the area against the reduced pressure for works of separation and a hard wall (thesis Fig. 5.3).

    Thin: the repulsion of each law alone, and adhesion with a stiff one. kappa_r: the thesis's constant without
    adhesion.
    """
    data, wall = with_indentation(data), with_indentation(wall)
    ends, works = np.array([0.0, 2.0]), data.work_of_separation.values.tolist()
    tables = []
    for panel, end in zip(axes, FIG_5_3_ENDS, strict=True):
        for work, colour in rough.work_colours(works).items():
            variant, label = data.sel(work_of_separation=work), rough.work_label(data, work)
            tables.append(rough.plot_against_pressure(panel, variant, label, reduced=True, end=end, color=colour))
        tables += rough.plot_thin_against_pressure(panel, repulsive, stiff, works, end)
        look = rough.WALL_LOOK | {"lw": 1.4}
        tables.append(rough.plot_against_pressure(panel, wall, "hard wall", reduced=True, end=end, **look))
        thesis = {"color": style.GREY, "lw": 0.8, "ls": style.THESIS, "label": f"thesis, {kappa_r:g}", "zorder": 0}
        panel.plot(ends, kappa_r * ends, **thesis)
        panel.set(xlabel=r"reduced pressure $p_r^*$", ylabel=rough.LABELS[rough.AREA])
    axes[0].set(xlim=rough.plotted_range(axes[0], -0.015, 0.06), ylim=(0, 1.02))
    axes[1].set(xlim=(-0.004, 0.012), ylim=(0, 0.5))
    axes[1].xaxis.set_major_locator(MaxNLocator(5))
    handles = [*rough.repulsion_handles(), rough.falling_handle()]
    axes[0].legend(handles=handles, loc="center right", bbox_to_anchor=(1.0, 0.52))
    axes[1].legend(loc="upper left", bbox_to_anchor=(0.0, 0.87), labelspacing=0.3)
    style.add_letters(axes)
    return pd.concat(tables)


def fig_5_4(
    data: xr.Dataset, wall: xr.Dataset, repulsive: xr.Dataset, stiff: xr.Dataset, axes: list[Axes]
) -> pd.DataFrame:
    """Plot pressure, gradient in contact and area against the approach (thesis Fig. 5.4)."""
    data, wall, repulsive, stiff = (with_indentation(paths) for paths in (data, wall, repulsive, stiff))
    works = data.work_of_separation.values.tolist()
    names = ("normalised_pressure", "gradient_ratio_interacting", rough.AREA)
    tables = {}
    for panel, name in zip(axes, names, strict=True):
        curves = rough.plot_works(panel, data, wall, name, rough.indentation)
        curves += rough.plot_repulsions(panel, repulsive, stiff, works, name, rough.indentation)
        tables[name] = pd.concat(curves)
        panel.set(xlabel=rough.LABELS["indentation"], ylabel=rough.LABELS[name], xlim=(-7, 24.5))
    _add_pulls(axes[0])
    axes[1].set_ylim(0.5, 1.15)
    axes[1].legend(handles=rough.repulsion_handles(), loc="lower right")
    axes[2].legend(loc="upper left")
    style.add_letters(axes)
    return tables[names[0]]


def _add_pulls(axes: Axes) -> None:
    """Enlarge the pressures about zero in an inset."""
    inset = axes.inset_axes((0.4, 0.5, 0.4, 0.45))
    for line in list(axes.lines):
        look = {"color": line.get_color(), "ls": line.get_linestyle(), "lw": 0.8}
        inset.plot(line.get_xdata(), line.get_ydata(), **look)
    inset.axhline(0.0, **style.ZERO)
    inset.set(xlim=axes.get_xlim(), ylim=(-2.5e-3, 2.5e-3))
    inset.tick_params(labelsize=7)


def fig_5_5(data: xr.Dataset, wall: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Plot the interface with the strongest adhesion and with a hard wall (thesis Fig. 5.5)."""
    table = interfaces.plot_beside_wall(axes, data, wall, COVER_PICTURE)
    axes.legend(loc="lower left")
    interfaces.add_magnification(axes)
    return table


def cover(data: xr.Dataset, wall: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Plot the rough profile and the surface below it, with adhesion and without: the thesis's cover."""
    table = interfaces.plot_beside_wall(axes, data, wall, COVER_PICTURE)
    lower = np.minimum(table.surface, table.wall)
    bottom = float(lower.min()) - 8.0
    axes.fill_between(table.x, bottom, lower, color="#f0e6d2", lw=0, zorder=0)
    interfaces.add_scale_bars(axes, float(table.x.iloc[0]), bottom + 1.5)
    axes.set_ylim(bottom, float(table.rigid.max()) + 5.0)
    axes.axis("off")
    axes.legend(loc="lower right")
    return table


def fig_5_6(
    data: xr.Dataset,
    middle: xr.Dataset,
    high: xr.Dataset,
    exponents_data: xr.Dataset,
    wall: xr.Dataset,
    axes: list[Axes],
) -> pd.DataFrame:
    """Plot the area against the pressure for rms heights and Hurst exponents (thesis Fig. 5.6).

    The hard wall, with H = 0.8 and 10 nm, is the straight line that contacts are said to approach.
    """
    strong, wall = _strongest(data), with_indentation(wall)
    heights = {10.0: strong, 15.0: middle, 30.0: high}
    exponents = {
        float(value): exponents_data.sel(hurst_exponent=value) for value in exponents_data.hurst_exponent.values
    } | {0.8: strong}
    tables = []
    for panel, variants, symbol, unit in (
        (axes[0], heights, r"h_{\mathrm{rms}}", " nm"),
        (axes[1], exponents, "H", ""),
    ):
        for value, variant in variants.items():
            label = f"${symbol}={value:g}${unit}"
            colour = style.hurst_colour(0.8 if variant is strong or variants is heights else value)
            if variants is heights and variant is not strong:
                colour = style.variable_colours("surface_rms_height", value)[value]
            tables.append(rough.plot_against_pressure(panel, with_indentation(variant), label, color=colour))
        tables.append(rough.plot_against_pressure(panel, wall, "hard wall", **rough.WALL_LOOK))
        rough.label_pressures(panel)
    style.add_letters(axes)
    return pd.concat(tables)


def _strongest(data: xr.Dataset) -> xr.Dataset:
    """Return the variant with the largest work of separation."""
    return data.sel(work_of_separation=data.work_of_separation.max())


def fig_5_7(
    data: xr.Dataset, exponents_data: xr.Dataset, coarse: xr.Dataset, coarsest: xr.Dataset, axes: list[Axes]
) -> pd.DataFrame:
    """Plot the area against the pressure with fewer and fewer short waves, and the interface (thesis Fig. 5.7)."""
    whole = {0.8: _strongest(data), 0.2: exponents_data.sel(hurst_exponent=0.2)}
    tables = []
    for value, variant in whole.items():
        variants = {
            interfaces.MANY_WAVES: variant,
            128: coarse.sel(hurst_exponent=value),
            interfaces.FEW_WAVES: coarsest.sel(hurst_exponent=value),
        }
        for (waves, paths), line in zip(variants.items(), ("-", "--", ":"), strict=True):
            look = {"color": style.hurst_colour(value), "ls": line, "marker": style.HURST_LOOKS[value][0]}
            label = rf"$H={value:g}$, {interfaces.waves_label(waves)}"
            tables.append(rough.plot_against_pressure(axes[0], with_indentation(paths), label, **look))
    rough.label_pressures(axes[0])
    for panel, (value, variant), share in zip(axes[1:], whole.items(), (PICTURE, CLOSE_UP), strict=True):
        interfaces.plot_waves(panel, variant, coarsest.sel(hurst_exponent=value), share, style.hurst_colour(value))
        panel.set_title(f"$H={value:g}$", fontsize=9)
    style.add_letters(axes)
    return pd.concat(tables)


def fig_5_8(data: xr.Dataset, normal: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the area by the coupled law for Poisson's ratios and ratios of works (thesis Fig. 5.8)."""
    tables = []
    colours = style.variable_colours("poisson_ratio", data.poisson_ratio)
    for ratio, work in product(data.poisson_ratio.values, data.work_ratio.values):
        variant = with_indentation(data.sel(poisson_ratio=ratio, work_ratio=work))
        look = {"color": colours[float(ratio)], "ls": "-" if work else "--", "marker": "s" if work else "o"}
        label = _variant_label(ratio, work)
        tables.append(rough.plot_against_pressure(axes[0], variant, label, **look))
        rough.plot_path(axes[1], variant, variant.indentation, rough.AREA, label, lw=1.0, **look)
    strong = with_indentation(_strongest(normal))
    look = {"color": style.EXACT, "ls": ":", "marker": "."}
    tables.append(rough.plot_against_pressure(axes[0], strong, "uncoupled", **look))
    rough.label_pressures(axes[0])
    axes[1].set(xlabel=rough.LABELS["indentation"], ylabel=rough.LABELS[rough.AREA])
    style.add_letters(axes)
    return pd.concat(tables)


def _variant_label(ratio: float, work: float) -> str:
    """Return the label of a Poisson's ratio and a ratio of works."""
    return rf"$\nu={ratio:g}$, $c={work:g}$"


def effects_auto(data: xr.Dataset, whole: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the area with all effects and without negligible ones, and the work of both (beyond the thesis)."""
    rows, shares = [], {}
    colours = style.variable_colours("poisson_ratio", data.poisson_ratio)
    for row, (ratio, work) in enumerate(product(data.poisson_ratio.values, data.work_ratio.values)):
        variants = (part.sel(poisson_ratio=ratio, work_ratio=work) for part in (data, whole))
        simplified, complete = map(with_indentation, variants)
        colour, label, saving = colours[float(ratio)], _variant_label(ratio, work), Saving.of(simplified, complete)
        savings.plot_simplified(axes[0], simplified, complete, label, colour, work)
        for offset, value, alpha, words in (
            (0.2, saving.transforms, 1.0, "what was done"),
            (-0.2, saving.transforms_whole, style.FAINT, "all effects"),
        ):
            axes[1].barh(-row + offset, value, 0.36, color=colour, alpha=alpha, label=f"{label}, {words}")
        shares[label] = saving.transforms / saving.transforms_whole
        place = {"poisson_ratio": ratio, "work_ratio": work, "change_of_mean": saving.change_of_mean}
        place |= {"saved": saving.factor, "transforms": saving.transforms}
        rows.append(place | {"transforms_whole": saving.transforms_whole, "decision": saving.decision})
    axes[0].set(xlabel=rough.LABELS["indentation"], ylabel=rough.LABELS[rough.AREA])
    axes[0].legend(loc="best", fontsize=7)
    savings.label_savings(axes[1], shares)
    style.add_letters(axes)
    return pd.DataFrame(rows)
