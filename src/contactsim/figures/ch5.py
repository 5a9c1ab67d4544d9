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
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from contactsim.adhesion import CRITERION, INTERACTING, LEGS, legs
from contactsim.ensemble import converged, relative_change
from contactsim.figures import notation, style
from contactsim.figures import rough_curves as rough

AVERAGES = ("relative_contact_area", "kappa_r", "kappa_r_bond", "reduced_pressure_contact")
LINES = ("-", ":", "-.", "--")
"""Lines of thicknesses, the largest first."""
FAINT = 0.35
WALL_LOOK = {"color": style.EXACT, "ls": "--", "lw": 1.0, "marker": "x"}
INTERFACE, SHOWN, COVERED, CLOSE_UP = 20.0, 0.12, 0.3, 0.05
"""Approach (nm) beyond first touch of the pictures of the interface, and the parts of the period that they show."""
BESIDE = ({"ha": "center", "va": "bottom"}, {"ha": "right", "va": "center"})
"""Where words stand at a bar along x, and at one along z."""
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
    data, wall, rows, name = rough.prepared(data), rough.prepared(wall), [], "relative_interacting_area"
    for panel in axes:
        for work, color in rough.works(data).items():
            one = data.sel(work_of_separation=work)
            words = rough.work_words(data, work)
            rows.append(rough.curve(panel, one, rough.reduced(one), name, words, color=color, lw=1.0))
        rows.append(rough.curve(panel, wall, rough.reduced(wall), name, "hard wall", **WALL_LOOK))
        dense = np.array([0.0, 2.0])
        panel.plot(dense, kappa_r * dense, color=style.EXACT, lw=0.8, ls=(0, (6, 3)), label=f"thesis, {kappa_r:g}")
        panel.set(xlabel=r"reduced pressure $p_r^*$", ylabel=rough.LABELS["relative_interacting_area"])
    axes[0].set(xlim=_reached(axes[0], -0.015, 0.06), ylim=(0, 1.02))
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
        for work, color in rough.works(data).items():
            one = data.sel(work_of_separation=work)
            words = rough.work_words(data, work)
            rows.append(rough.curve(panel, one, one.indentation, name, words, color=color, lw=1.0))
        rows.append(rough.curve(panel, wall, wall.indentation, name, "hard wall", **WALL_LOOK))
        panel.set(xlabel=rough.LABELS["indentation"], ylabel=rough.LABELS[name], xlim=(-7, 24.5))
    axes[0].set_yscale("symlog", linthresh=1e-3)
    axes[1].set_ylim(0, 1.4)
    axes[2].legend(loc="upper left")
    style.letters(axes)
    return pd.concat(rows[: len(rows) // 3])


def fig_5_5(data: xr.Dataset, wall: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """The interface at an approach with the strongest adhesion and with a hard wall (thesis Fig. 5.5)."""
    strong = data.sel(work_of_separation=data.work_of_separation.max())
    part = _window(strong)
    looks = {"color": style.PAIRS, "label": rough.work_words(data, float(strong.work_of_separation))}
    shown = rough.interface(axes, strong, INTERFACE, looks, part)
    surface = _wall_surface(wall)[part]
    axes.plot(shown.x, surface, color=style.WHOLE, lw=0.9, label="hard wall")
    axes.set(xlabel="$x$ (nm)", ylabel="$z$ (nm)")
    axes.legend(loc="lower left")
    return shown.assign(wall=surface)


def cover(data: xr.Dataset, wall: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """The rough profile and the surface below it, with adhesion and without: the thesis's cover."""
    strong = data.sel(work_of_separation=data.work_of_separation.max())
    part = _window(strong, COVERED)
    looks = {"color": style.PAIRS, "label": rough.work_words(data, float(strong.work_of_separation))}
    shown = rough.interface(axes, strong, INTERFACE, looks, part)
    surface = _wall_surface(wall)[part]
    axes.plot(shown.x, surface, color=style.WHOLE, lw=0.9, label="hard wall")
    depth = float(np.minimum(shown.surface, surface).min()) - 8.0
    axes.fill_between(shown.x, depth, np.minimum(shown.surface, surface), color="#f0e6d2", lw=0, zorder=0)
    begin, bottom = float(shown.x.iloc[0]), depth + 1.5
    for ends, words in (
        (([begin + 80, begin + 280], [bottom, bottom]), "200 nm"),
        (([begin + 80, begin + 80], [bottom, bottom + 10]), "10 nm"),
    ):
        axes.plot(*ends, color=style.EXACT, lw=1.5, solid_capstyle="butt")
        upright = ends[0][0] == ends[0][1]
        place = (begin + 65, bottom + 5) if upright else (begin + 180, bottom + 0.8)
        axes.text(*place, words, rotation=90 * upright, fontsize=7, **BESIDE[upright])
    axes.set_ylim(depth, float(shown.rigid.max()) + 5.0)
    axes.axis("off")
    axes.legend(loc="lower right")
    return shown.assign(wall=surface)


def _wall_surface(wall: xr.Dataset) -> np.ndarray:
    """Height (nm) of the surface of the first member under a hard wall, at its last approach."""
    one = wall.isel(member=0)
    return -one.heights.values - float(one.approach_first_touch) - INTERFACE - one.isel(step=-1).gap.values


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
            rows.append(_against_pressure(axes[0], rough.prepared(one), words, **look))
    _pressures(axes[0])
    pictures = ((axes[1], 0.8, strong, SHOWN), (axes[2], 0.2, hurst.sel(hurst=0.2), CLOSE_UP))
    for panel, value, whole, share in pictures:
        fewest = coarsest.sel(hurst=value)
        for one, count, color in ((whole, 512, style.CONTACT), (fewest, 64, style.WHOLE)):
            looks = {"color": color, "label": rf"$\epsilon_f=1/{count}$"}
            part = _about(one, _peak(whole), share)
            rough.interface(panel, one, INTERFACE, looks, part, filled=one is whole)
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
        rows.append(_against_pressure(axes[0], one, words, **look))
        rough.curve(axes[1], one, one.indentation, "relative_interacting_area", words, lw=1.0, **look)
    strong = rough.prepared(normal.sel(work_of_separation=normal.work_of_separation.max()))
    rows.append(_against_pressure(axes[0], strong, "uncoupled", color=style.EXACT, ls=":", marker="."))
    _pressures(axes[0])
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
        spent = float(less.transforms.sum() + less.transforms_of_check.sum()), float(more.transforms.sum())
        for offset, value, alpha in zip((0.2, -0.2), spent, (1.0, FAINT), strict=True):
            axes[1].barh(-place + offset, value, 0.36, color=color, alpha=alpha)
        told = str(less.decision.isel(member=0).item())
        lines.append(f"{words}: {spent[0] / spent[1]:.2g} of the work; {told}")
        twice = {"saved": spent[1] / spent[0], "transforms": spent[0], "transforms_whole": spent[1], "decision": told}
        same = less.member.values, "area_at_twelve"
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
    modulus, rows = float(data.contact_modulus), []
    for height, color in style.shades(data.surface_rms_height.values).items():
        one = data.sel(surface_rms_height=height).isel(member=0)
        indentation = (one.approach - one.approach_first_touch).values
        shown = {"rms_height": height, "indentation": indentation}
        for name, panel in names.items():
            shown[name] = converged(one[name], one).values
            for leg, part in zip(LEGS, legs(indentation), strict=True):
                part = slice(max(part.start - 1, 0), part.stop)
                words = rf"$h_{{\mathrm{{rms}}}}={height:g}$ nm" if leg == LEGS[0] else None
                look = {"color": color, "lw": 1.0, "ls": "-" if leg == LEGS[0] else "--", "label": words}
                panel.plot(indentation[part], shown[name][part], **look)
            panel.set(xlabel=rough.LABELS["indentation"], ylabel=rough.LABELS[name])
        rows.append(pd.DataFrame(shown))
    axes[0].axhline(0.0, color=style.EXACT, lw=0.5)
    axes[1].legend(loc="upper left")
    ends = {}
    for leg, fill in zip(LEGS, (style.CONTACT, "white"), strict=True):
        scale = 1 / (float(data.length) * modulus)
        ends |= _against_height(axes[2], data, f"pull_off_load_{leg}", scale, leg, style.CONTACT, fill)
    axes[2].set_ylabel(r"pull-off $-p/E^*$")
    work = rough.work(data)
    ends |= _against_height(axes[3], data, "dissipated_work", 1 / work, "per cycle", style.WHOLE, style.WHOLE)
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
        areas = {name: converged(one[name], one) / one.length for name in ("repulsive_length", *INTERACTING)}
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


def _against_height(
    panel: Axes, data: xr.Dataset, name: str, scale: float, words: str, color: str, fill: str
) -> dict[str, np.ndarray]:
    """Mean over members against the rms height; bars: standard error and what the increments leave open, together."""
    values, count = data[name], data[name].count("member")
    spread = values.std("member", ddof=1) / np.sqrt(count)
    error = np.hypot(spread, data[f"{name}_increment_error"].mean("member"))
    look = {"fmt": "o-", "ms": 4, "mfc": fill, "color": color, "lw": 0.8, "elinewidth": 0.8, "capsize": 1.5}
    mean = values.mean("member")
    panel.errorbar(data.surface_rms_height.values, scale * mean.values, scale * error.values, label=words, **look)
    return {f"{name}_mean": mean.values, f"{name}_error": error.values, f"{name}_members": count.values}


def _against_pressure(panel: Axes, one: xr.Dataset, words: str, **look: object) -> pd.DataFrame:
    return rough.curve(panel, one, one.normalised_pressure_mean, "relative_interacting_area", words, lw=1.0, **look)


def _pressures(panel: Axes) -> None:
    """Area against pressure, as far as the contact is not yet whole."""
    panel.set(xlabel=rough.LABELS["normalised_pressure"], ylabel=rough.LABELS["relative_interacting_area"])
    panel.set(xlim=_reached(panel, -0.006, 0.03), ylim=(0, 1.02))
    panel.legend(loc="best", fontsize=6.5)


def _reached(panel: Axes, least: float, most: float) -> tuple[float, float]:
    """The part of a range of pressures that curves reach, with a margin."""
    drawn = np.concatenate([np.asarray(line.get_xdata(), float) for line in panel.lines])
    drawn = drawn[np.isfinite(drawn) & (drawn > least) & (drawn < most)]
    margin = 0.06 * np.ptp(drawn)
    return max(drawn.min() - margin, least), min(drawn.max() + margin, most)


def _window(one: xr.Dataset, share: float = SHOWN) -> slice:
    """A part of the period about the highest point, which touches first."""
    return _about(one, _peak(one), share)


def _peak(one: xr.Dataset) -> float:
    """Where the highest point of the first member is, in parts of the period."""
    heights = one.heights.isel(member=0).values
    return float(np.argmax(heights)) / heights.size


def _about(one: xr.Dataset, place: float, share: float) -> slice:
    """A part of the period about a place, also given as a part of it."""
    count = one.x.size
    width = int(count * share)
    middle = int(np.clip(round(place * count), width // 2, count - width // 2))
    return slice(middle - width // 2, middle + width // 2)


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
    change.legend(handles=_shades({notation.SYMBOLS[name]: alpha for name, alpha in SHADES.items()}), loc="lower right")
    factor.legend(handles=_shades({"Eq. 3.8": 1.0, "pairs in contact": FAINT}), loc="upper right")
    last.legend(handles=_shades({"Eq. 3.8": 1.0, "pairs in contact": FAINT}), loc="lower left")


def _shades(names: dict[str, float]) -> list[Line2D]:
    return [Line2D([], [], color=style.EXACT, alpha=alpha, lw=1.5, label=name) for name, alpha in names.items()]


def _power(value: float) -> str:
    """A number as it is, a large one as a power of ten."""
    return f"{value:g}" if value < 1e5 else f"10^{{{np.log10(value):.3g}}}"
