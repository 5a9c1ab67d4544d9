"""Chapter 5: rough contact of compressible bodies. Each function draws one figure and returns the numbers it shows.

Values of the thesis, from `reference` in the config, come as keywords.
"""

from __future__ import annotations

import textwrap
from itertools import product

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from contactsim.analysis.ensemble import converged, relative_change
from contactsim.figures import style
from contactsim.figures.parts import interfaces, thicknesses
from contactsim.figures.parts import rough_curves as rough
from contactsim.observables.adhesion import CRITERION, INTERACTING, LEGS

AVERAGES = ("relative_contact_area", "kappa_r", "kappa_r_pairs", "reduced_pressure_contact")
SHOWN, COVERED, CLOSE_UP = 0.12, 0.3, 0.05
"""Parts of the period that pictures of the interface show."""


def fig_5_2(data: xr.Dataset, axes: list[Axes], *, kappa_r: float) -> pd.DataFrame:
    """Area, κ_r, what the layer changes and the grid error, for H, Poisson's ratio and thickness (thesis Fig. 5.2).

    The thickest body is what the others are held against, and the one whose κ_r is drawn over pairs of neighbours in
    contact too. kappa_r: the thesis's constant.
    """
    area, factor, change, _ = axes
    thickest = float(data.thickness.max())
    for name in thicknesses.SHADES:
        data = data.merge(relative_change(data, name, "thickness", thickest))
    thicknesses.curves(data, axes)
    dense = np.array([float(data.reduced_pressure_contact_mean.min()), float(data.reduced_pressure_contact_mean.max())])
    area.plot(dense, kappa_r * dense, color=style.EXACT, lw=0.8, ls=(0, (6, 3)))
    factor.axhline(kappa_r, color=style.EXACT, lw=0.8, ls=(0, (6, 3)))
    change.axhline(0.0, color=style.EXACT, lw=0.6)
    thicknesses.frame(data, axes, kappa_r)
    return style.averages(data, AVERAGES)


def fig_5_3(data: xr.Dataset, wall: xr.Dataset, axes: list[Axes], *, kappa_r: float) -> pd.DataFrame:
    """Area against reduced pressure for works of separation, with the hard wall (thesis Fig. 5.3).

    kappa_r: the thesis's constant without adhesion.
    """
    data, wall, rows, name = rough.prepared(data), rough.prepared(wall), [], "relative_interacting_area"
    for panel in axes:
        rows += rough.of_works(panel, data, wall, rough.reduced, name)
        dense = np.array([0.0, 2.0])
        panel.plot(dense, kappa_r * dense, color=style.EXACT, lw=0.8, ls=(0, (6, 3)), label=f"thesis, {kappa_r:g}")
        panel.set(xlabel=r"reduced pressure $p_r^*$", ylabel=rough.LABELS["relative_interacting_area"])
    axes[0].set(xlim=rough.reached(axes[0], -0.015, 0.06), ylim=(0, 1.02))
    axes[1].set(xlim=(-0.004, 0.012), ylim=(0, 0.5))
    axes[1].xaxis.set_major_locator(MaxNLocator(5))
    axes[1].legend(loc="lower right", bbox_to_anchor=(1.0, 0.07))
    style.letters(axes)
    return pd.concat(rows[: len(rows) // 2])


def fig_5_4(data: xr.Dataset, wall: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Pressure, gradient in contact and area against approach (thesis Fig. 5.4)."""
    data, wall, rows = rough.prepared(data), rough.prepared(wall), []
    names = ("normalised_pressure", "gradient_ratio_interacting", "relative_interacting_area")
    for panel, name in zip(axes, names, strict=True):
        rows += rough.of_works(panel, data, wall, lambda one: one.indentation, name)
        panel.set(xlabel=rough.LABELS["indentation"], ylabel=rough.LABELS[name], xlim=(-7, 24.5))
    axes[0].set_yscale("symlog", linthresh=1e-3)
    axes[1].set_ylim(0, 1.4)
    axes[2].legend(loc="upper left")
    style.letters(axes)
    return pd.concat(rows[: len(rows) // 3])


def fig_5_5(data: xr.Dataset, wall: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """The interface at an approach with the strongest adhesion and with a hard wall (thesis Fig. 5.5)."""
    shown = interfaces.beside_wall(data, wall, axes, SHOWN)
    axes.set(xlabel="$x$ (nm)", ylabel="$z$ (nm)")
    axes.legend(loc="lower left")
    return shown


def cover(data: xr.Dataset, wall: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """The rough profile and the surface below it, with adhesion and without: the thesis's cover."""
    shown = interfaces.beside_wall(data, wall, axes, COVERED)
    lower = np.minimum(shown.surface, shown.wall)
    depth = float(lower.min()) - 8.0
    axes.fill_between(shown.x, depth, lower, color="#f0e6d2", lw=0, zorder=0)
    interfaces.scale_bars(axes, float(shown.x.iloc[0]), depth + 1.5)
    axes.set_ylim(depth, float(shown.rigid.max()) + 5.0)
    axes.axis("off")
    axes.legend(loc="lower right")
    return shown


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
            rows.append(rough.against_pressure(panel, one, f"${symbol}={value:g}${unit}", color=color))
        rough.pressures(panel)
    style.letters(axes)
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
            rows.append(rough.against_pressure(axes[0], rough.prepared(one), words, **look))
    rough.pressures(axes[0])
    pictures = ((axes[1], 0.8, strong, SHOWN), (axes[2], 0.2, hurst.sel(hurst=0.2), CLOSE_UP))
    for panel, value, whole, share in pictures:
        fewest = coarsest.sel(hurst=value)
        for one, count, color in ((whole, 512, style.CONTACT), (fewest, 64, style.WHOLE)):
            looks = {"color": color, "label": rf"$\epsilon_f=1/{count}$"}
            part = interfaces.about(one, interfaces.peak(whole), share)
            interfaces.interface(panel, one, interfaces.INTERFACE, looks, part, filled=one is whole)
        panel.set(xlabel="$x$ (nm)", ylabel="$z$ (nm)")
        panel.set_title(f"$H={value:g}$", fontsize=9)
        panel.legend(loc="lower right")
    style.letters(axes)
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
        rows.append(rough.against_pressure(axes[0], one, words, **look))
        rough.curve(axes[1], one, one.indentation, "relative_interacting_area", words, lw=1.0, **look)
    strong = rough.prepared(normal.sel(work_of_separation=normal.work_of_separation.max()))
    rows.append(rough.against_pressure(axes[0], strong, "uncoupled", color=style.EXACT, ls=":", marker="."))
    rough.pressures(axes[0])
    axes[1].set(xlabel=rough.LABELS["indentation"], ylabel=rough.LABELS["relative_interacting_area"])
    style.letters(axes)
    return pd.concat(rows)


def effects_auto(data: xr.Dataset, whole: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Area with all effects and without those found negligible, and the work of both (beyond the thesis)."""
    rows, lines = [], []
    colours = style.shades(data.poisson_ratio.values)
    for place, (ratio, work) in enumerate(product(data.poisson_ratio.values, data.work_ratio.values)):
        less, more = (rough.prepared(one.sel(poisson_ratio=ratio, work_ratio=work)) for one in (data, whole))
        color, words = colours[float(ratio)], rf"$\nu={ratio:g}$, $c={work:g}$"
        look = {"color": color, "ls": "-" if work else "--"}
        rough.curve(axes[0], more, more.indentation, "relative_interacting_area", words, marker="", lw=1.0, **look)
        known = rough.settled(less)
        mean, error = (less[f"relative_interacting_area_{kind}"][known] for kind in rough.ENDS)
        marker = {"marker": "s" if work else "o", "mfc": "white", "ls": "", "ms": 4}
        axes[0].errorbar(less.indentation[known], mean, error, color=color, **marker)
        spent = float(less.transforms.sum() + less.check_transforms.sum()), float(more.transforms.sum())
        for offset, value, alpha in zip((0.2, -0.2), spent, (1.0, thicknesses.FAINT), strict=True):
            axes[1].barh(-place + offset, value, 0.36, color=color, alpha=alpha)
        told = str(less.decision.isel(member=0).item())
        lines.append(f"{words}: {spent[0] / spent[1]:.2g} of the work; {told}")
        twice = {"saved": spent[1] / spent[0], "transforms": spent[0], "transforms_whole": spent[1], "decision": told}
        same = less.member.values, "area_at_12nm"
        change = abs(less[same[1]].mean("member") / more[same[1]].sel(member=same[0]).mean("member") - 1)
        rows.append({"poisson_ratio": ratio, "work_ratio": work, "change_of_mean": float(change)} | twice)
    table = pd.DataFrame(rows)
    axes[0].set(xlabel=rough.LABELS["indentation"], ylabel=rough.LABELS["relative_interacting_area"])
    axes[0].legend(loc="best", fontsize=6.5)
    count = len(table)
    axes[1].set(ylim=(-2 * count, 0.6), xlabel="transforms of all members: full, what was done; faint, all effects")
    axes[1].set(yticks=-np.arange(count), yticklabels=[line.partition(":")[0] for line in lines])
    text = "\n".join("\n".join(textwrap.wrap(line, 100, subsequent_indent="   ")) for line in lines)
    axes[1].text(0.02, 0.02, text, transform=axes[1].transAxes, fontsize=5, va="bottom")
    style.letters(axes)
    return table


def unloading(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Cycles of approach and retraction for rms heights: loops, pull-off and what is dissipated (beyond the thesis)."""
    names = {"normalised_pressure": axes[0], "relative_interacting_area": axes[1]}
    rows = rough.cycles(data, names)
    axes[0].axhline(0.0, color=style.EXACT, lw=0.5)
    axes[1].legend(loc="upper left")
    ends = {}
    for leg, fill in zip(LEGS, (style.CONTACT, "white"), strict=True):
        scale = 1 / (float(data.length) * float(data.contact_modulus))
        ends |= rough.against_height(axes[2], data, f"pull_off_load_{leg}", scale, leg, style.CONTACT, fill)
    axes[2].set_ylabel(r"pull-off $-p/E^*$")
    work = rough.work(data)
    ends |= rough.against_height(axes[3], data, "dissipated_work", 1 / work, "per cycle", style.WHOLE, style.WHOLE)
    axes[3].set_ylabel(r"dissipated energy / $\varphi_n$")
    for panel in axes[2:]:
        panel.set(xlabel=r"$h_{\mathrm{rms}}$ (nm)")
    axes[2].set_yscale("log")
    axes[2].legend(loc="upper right")
    style.letters(axes)
    return pd.concat([*rows, pd.DataFrame({"rms_height": data.surface_rms_height.values} | ends)])


def thresholds(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Relative area by every criterion, for the strongest and the weakest adhesion (beyond the thesis)."""
    chosen = data.work_of_separation.max(), data.work_of_separation.min()
    rows = []
    for panel, work in zip(axes, chosen, strict=False):
        one = rough.prepared(data.sel(work_of_separation=work))
        areas = {name: converged(one[name], one) / one.length for name in ("contact_length", *INTERACTING)}
        middle = areas[CRITERION].mean("member")
        for (name, area), color in zip(areas.items(), style.shades(range(len(areas))).values(), strict=True):
            mean, error = area.mean("member"), area.std("member", ddof=1) / np.sqrt(area.count("member"))
            words = f"above {INTERACTING[name]:g} of the strength" if name in INTERACTING else "repulsive"
            panel.plot(one.indentation, mean, color=color, lw=1.0, label=words)
            panel.errorbar(one.indentation[-1], mean[-1], error[-1], color=color, elinewidth=0.8, capsize=1.5)
            if work == chosen[0]:
                axes[2].plot(one.indentation, mean / middle, color=color, lw=1.0)
            shown = {"indentation": one.indentation, "area": mean, "standard_error": error}
            rows.append(pd.DataFrame(shown).assign(criterion=name, work_of_separation=float(work)))
        panel.set(xlabel=rough.LABELS["indentation"], ylabel=rough.LABELS["relative_interacting_area"], ylim=(0, 1))
        panel.set_title(rough.work_words(data, float(work)), fontsize=9)
    axes[0].legend(loc="upper left")
    axes[2].set(xlabel=rough.LABELS["indentation"], ylabel="area over that above a hundredth", yscale="log")
    style.letters(axes)
    return pd.concat(rows)
