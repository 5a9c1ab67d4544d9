"""Chapter 4: smooth adhesive asperities. Each function draws one figure and returns the numbers that it shows.

Values of the thesis, from `reference` in the config, come as keywords. Loads are per unit thickness; as in the thesis
they are divided by πRφ0 with φ0 = 1 N/m, which leaves a number only for a thickness of 1 µm.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim import analytic
from contactsim.adhesion import LEGS
from contactsim.build import elastic
from contactsim.fields import inside
from contactsim.figures import load_curves as curves
from contactsim.figures import stress, style
from contactsim.grid import Array, Grid

INDENTED, APPROACHING = 10.0, -5.0
"""Approaches (nm) at which fields are kept."""
REFERENCE_WORK = 2.0
"""Work of separation, N/m, of the figures for which the thesis names one."""
FRICTION = {0.0: "--", 0.1: "-.", 0.5: ":", 1.0: "-"}
"""Line of a ratio of works."""
FELT = 0.01
"""Part of the largest load below which a curve is not worth showing."""
COUPLING = {"coupled": "-", "uncoupled": "--"}


def _friction(ratio: float) -> object:
    return FRICTION.get(round(float(ratio), 6), (0, (1, 3)))


def _ratio_words(ratio: float) -> str:
    return rf"$\varphi_t/\varphi_n={float(ratio):g}$"


def fig_4_2(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Normal traction at the largest approach with and without friction, for two works (thesis Fig. 4.2)."""
    rows = []
    for panel, work in zip(axes, (REFERENCE_WORK, 0.8), strict=True):
        parts = [data.sel(work_of_separation=work, work_ratio=ratio) for ratio in (0.0, 1.0)]
        rows.append(_profiles(panel, parts, work).assign(work_of_separation=work))
        panel.set_title(rf"$\varphi_n={work:g}$ N/m", fontsize=9)
    style.letters(axes)
    return pd.concat(rows)


def fig_4_3(pulled: xr.Dataset, more: xr.Dataset, close: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """The same for a nearly incompressible layer, and for asperities close to each other (thesis Fig. 4.3)."""
    soft = pulled.sel(poisson_ratio=0.45, work_of_separation=REFERENCE_WORK)
    cases = {
        r"$\nu=0.45$, $w/R=0.4$": [soft.sel(work_ratio=0.0), more.sel(work_ratio=1.0)],
        r"$\nu=0.3$, $w/R=0.08$": [close.sel(work_ratio=ratio) for ratio in (0.0, 1.0)],
    }
    rows = []
    for panel, (words, parts) in zip(axes, cases.items(), strict=True):
        rows.append(_profiles(panel, parts, REFERENCE_WORK).assign(case=words.replace("$", "")))
        panel.set_title(words, fontsize=9)
    style.letters(axes)
    return pd.concat(rows)


def _profiles(panel: Axes, parts: list[xr.Dataset], work: float) -> pd.DataFrame:
    """Normal traction over the strength across the contact, one curve a ratio of works."""
    rows, widest = [], 0.0
    for one in parts:
        radius, ratio = curves.radius(one), float(one.work_ratio)
        place, order = curves.centred(one)
        here = one.isel(member=0).sel(snapshot=INDENTED, method="nearest", tolerance=style.SAME)
        strength = float(one.strength.isel(member=0)) if "member" in one.strength.dims else float(one.strength)
        traction = here.normal_traction.values[order] / strength
        size = float(one.final_repulsive_length.isel(member=0))
        words = rf"{_ratio_words(ratio)}, $l_{{\mathrm{{rep}}}}/R$ = {size / radius:.4f}"
        color = style.CONTACT if ratio else style.WHOLE
        panel.plot(place / radius, traction, color=color, ls=_friction(ratio), lw=1.1, label=words)
        widest = max(widest, float(np.abs(place[np.abs(traction) > 0.01]).max()))
        rows.append(
            pd.DataFrame({"position": place, "normal_traction": traction * strength}).assign(
                work_ratio=ratio, repulsive_length=size
            )
        )
    panel.axhline(0.0, color=style.EXACT, lw=0.5)
    panel.set(xlim=(-1.1 * widest / radius, 1.1 * widest / radius), xlabel=r"$x/R$")
    panel.set_ylabel(r"$T_n/\sigma_{\max}$ (pull positive)")
    low, high = panel.get_ylim()
    panel.set_ylim(low, high + 0.28 * (high - low))
    panel.legend(loc="upper center")
    shown = pd.concat(rows)
    return shown[np.abs(shown.position) <= 1.1 * widest].assign(strength=work / np.e)


def fig_4_4(
    data: xr.Dataset, pulled: xr.Dataset, more: xr.Dataset, close: xr.Dataset, thick: xr.Dataset, axes: list[Axes]
) -> pd.DataFrame:
    """Contact size against the ratio of works: for several works, and for other bodies (thesis Fig. 4.4)."""
    left, right, last = axes
    soft = [pulled.sel(poisson_ratio=0.45, work_of_separation=REFERENCE_WORK), more]
    works = style.shades(data.work_of_separation.values)
    cases = [
        (left, rf"$\varphi_n={work:g}$ N/m", [data.sel(work_of_separation=work)], works[work], "-") for work in works
    ]
    reference = (right, "reference", [data.sel(work_of_separation=REFERENCE_WORK)], works[REFERENCE_WORK], "-")
    others = [
        (right, r"$\nu=0.45$", soft, style.WHOLE, "--"),
        (right, r"$w/R=0.08$", [close], style.PAIRS, ":"),
        (right, r"$h/R=0.8$", [thick], style.EXACT, "-."),
    ]
    rows = []
    for panel, words, parts, color, line in [*cases, reference, *others]:
        sizes = _sizes(parts)
        look = {"color": color, "ls": line, "marker": "o", "ms": 3, "mfc": "white", "lw": 1.0, "elinewidth": 0.8}
        panel.errorbar(sizes.work_ratio, sizes.size_ratio, sizes.error, label=words, **look)
        if words != "reference":
            change = sizes.size_ratio / sizes.size_ratio.iloc[0] - 1
            last.plot(sizes.work_ratio, 100 * change, **{name: look[name] for name in look if name != "elinewidth"})
        rows.append(sizes.assign(case=words.replace("$", ""), panel="a" if panel is left else "b"))
    left.set(ylabel=r"contact size $l_{\mathrm{rep}}/R$")
    right.set(ylabel=r"$l_{\mathrm{rep}}/R$")
    last.set(ylabel=r"change from $\varphi_t=0$ (%)")
    last.axhline(0.0, color=style.EXACT, lw=0.5)
    for panel in axes:
        panel.set(xlabel=r"$c=\varphi_t/\varphi_n$")
    for panel in (left, right):
        low, high = panel.get_ylim()
        panel.set_ylim(low, high + 0.3 * (high - low))
        panel.legend(loc="upper left", ncols=2)
    style.letters(axes)
    return pd.concat(rows)


def _sizes(parts: list[xr.Dataset]) -> pd.DataFrame:
    """Contact size over the radius at each ratio of works, with its grid error, sorted."""
    rows = []
    for one in parts:
        radius = curves.radius(one)
        found = {"work_ratio": one.work_ratio.values}
        found["size_ratio"] = one.final_repulsive_length.isel(member=0).values / radius
        error = one.get("final_repulsive_length_grid_error")
        found["error"] = np.full(one.work_ratio.size, np.nan) if error is None else error.values / radius
        rows.append(pd.DataFrame(found))
    return pd.concat(rows).sort_values("work_ratio", ignore_index=True)


def fig_4_5(data: xr.Dataset, uncoupled: xr.Dataset, pulled: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Load against approach by the coupled and the uncoupled law, frictionless (thesis Fig. 4.5)."""
    smooth = data.sel(work_ratio=0.0)
    works = style.shades(uncoupled.work_of_separation.values)
    ratios = style.shades(uncoupled.poisson_ratio.values)
    rows = []
    for work, color in works.items():
        pair = smooth.sel(work_of_separation=work), uncoupled.sel(work_of_separation=work, poisson_ratio=0.3)
        rows += [_both_legs(axes[::2], pair, color, "a", work_of_separation=work, poisson_ratio=0.3)]
    for ratio, color in ratios.items():
        bodies = [one for one in (pulled, smooth.expand_dims(poisson_ratio=[0.3])) if ratio in one.poisson_ratio]
        with_friction = bodies[0].sel(poisson_ratio=ratio, work_of_separation=REFERENCE_WORK)
        if "work_ratio" in with_friction.dims:
            with_friction = with_friction.sel(work_ratio=0.0)
        pair = with_friction, uncoupled.sel(work_of_separation=REFERENCE_WORK, poisson_ratio=ratio)
        rows += [_both_legs(axes[1::2], pair, color, "b", work_of_separation=REFERENCE_WORK, poisson_ratio=ratio)]
    colours = {rf"$\varphi_n={work:g}$ N/m": color for work, color in works.items()}
    axes[0].legend(handles=style.key(colours, COUPLING), loc="upper left")
    axes[1].legend(
        handles=style.key({rf"$\nu={r:g}$": color for r, color in ratios.items()}, COUPLING), loc="upper left"
    )
    fixed = r"$\nu=0.3$", rf"$\varphi_n={REFERENCE_WORK:g}$ N/m"
    _load_axes(axes, tuple(f"{leg}, {words}" for leg in LEGS for words in fixed))
    return pd.concat(rows)


def _both_legs(panels: list[Axes], pair: tuple, color: str, panel: str, **place: float) -> pd.DataFrame:
    """Loading and unloading of the coupled and the uncoupled law."""
    rows = []
    for (name, line), one in zip(COUPLING.items(), pair, strict=True):
        for leg, axes in zip(LEGS, panels, strict=True):
            shown = curves.branch(axes, one.isel(member=0), leg, color=color, ls=line, lw=1.0)
            rows.append(shown.assign(panel=panel, law=name, leg=leg, **place))
    return pd.concat(rows)


def _load_axes(axes: list[Axes], titles: tuple[str, ...]) -> None:
    """Labels and titles of panels of load against approach, from where the surfaces first or last pull."""
    for panel, title in zip(axes, titles, strict=True):
        points = np.concatenate([line.get_xydata() for line in panel.lines])
        felt = points[np.abs(points[:, 1]) > FELT * np.nanmax(np.abs(points[:, 1])), 0]
        panel.set_xlim(felt.min() - 2.0, felt.max() + 1.0)
        panel.axhline(0.0, color=style.EXACT, lw=0.5)
        panel.set(xlabel=r"approach $\delta/\delta_n$", ylabel=curves.LOAD_LABEL)
        panel.set_title(title, fontsize=9)
    style.letters(axes)


def fig_4_6(pulled: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Deformed surface before the contact is closed, for two Poisson's ratios (thesis Fig. 4.6)."""
    rows = []
    colours = style.shades(pulled.poisson_ratio.values)
    for ratio, color in colours.items():
        one = pulled.sel(poisson_ratio=ratio, work_of_separation=REFERENCE_WORK, work_ratio=0.0)
        place, order = curves.centred(one)
        near = one.isel(member=0).sel(snapshot=APPROACHING, method="nearest", tolerance=style.SAME)
        moved = near.normal_displacement.values[order]
        for panel in axes:
            panel.plot(place / 1e3, moved, color=color, lw=1.1, label=rf"$\nu={ratio:g}$")
        rows.append(pd.DataFrame({"position": place, "normal_displacement": moved}).assign(poisson_ratio=ratio))
    shown = pd.concat(rows)
    far = shown[np.abs(shown.position) > 0.1 * np.ptp(shown.position)].normal_displacement
    margin = 0.15 * np.ptp(far)
    axes[1].set_ylim(far.min() - margin, far.max() + margin)
    for panel in axes:
        panel.axhline(0.0, color=style.EXACT, lw=0.5)
        panel.set(xlabel=r"$x$ (µm)", ylabel=r"displacement $u_z$ (nm)")
    axes[0].legend(loc="upper right")
    style.letters(axes)
    return shown


def fig_4_7(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Load against approach for three ratios of works (thesis Fig. 4.7)."""
    rows = []
    ratios = (0.0, 0.1, 1.0)
    for ratio, color in style.shades(ratios).items():
        one = data.sel(work_of_separation=REFERENCE_WORK, work_ratio=ratio).isel(member=0)
        for leg, panel in zip(LEGS, axes, strict=True):
            pull, at = (float(one[f"pull_off_{what}_{leg}"]) for what in ("load", "approach"))
            words = f"{_ratio_words(ratio)}: pull-off {pull:.1f} N/m at {at:.2f} nm"
            shown = curves.branch(panel, one, leg, color=color, ls=_friction(ratio), lw=1.1, label=words)
            rows.append(shown.assign(work_ratio=ratio, leg=leg))
    for panel in axes:
        panel.legend(loc="upper left")
    _load_axes(axes, LEGS)
    return pd.concat(rows)


def fig_4_8(pulled: xr.Dataset, axes: list[Axes], *, slope: float) -> pd.DataFrame:
    """Pull-off against work for two Poisson's ratios and three ratios of works (thesis Fig. 4.8).

    slope: the thesis's exponent.
    """
    rows = []
    radius = curves.radius(pulled)
    colours = style.shades(pulled.work_ratio.values)
    works = pulled.work_of_separation.values
    dense = np.geomspace(works[0], works[-1], 50)
    for panel, ratio in zip(axes, (0.45, 0.1), strict=True):
        body = pulled.sel(poisson_ratio=ratio).isel(member=0)
        for share, color in colours.items():
            one = body.sel(work_ratio=share)
            rows.append(_pull_offs(panel, one, color).assign(poisson_ratio=ratio, work_ratio=share))
        modulus = curves.settings(pulled)["body"]["youngs_modulus"] / (1 - ratio**2)
        first = float(
            curves.normalised(body.pull_off_load_loading.isel(work_of_separation=0).sel(work_ratio=0.0), body)
        )
        limits = {
            rf"$\bar\varphi_n^{{{'2/3' if np.isclose(slope, 2 / 3, atol=1e-3) else f'{slope:g}'}}}$": (
                first * (dense / works[0]) ** slope,
                ":",
            ),
            "JKR, half-space": (curves.normalised(analytic.cylinder_pull_off(dense, radius, modulus), body), "-"),
            "rigid": (
                curves.normalised(analytic.rigid_cylinder_pull_off(dense, radius, curves.normal_length(body)), body),
                (0, (6, 3)),
            ),
        }
        for values, line in limits.values():
            panel.plot(dense, values, color=style.EXACT, lw=0.8, ls=line)
        panel.set(xscale="log", yscale="log", xlabel=r"work of separation $\varphi_n/\varphi_0$")
        for axis, ends in ((panel.xaxis, panel.get_xlim()), (panel.yaxis, panel.get_ylim())):
            style.ticks(axis, *ends)
        panel.set_ylabel(curves.LOAD_LABEL.replace(r"$\bar L", r"pull-off $-\bar L", 1))
        panel.set_title(rf"$\nu={ratio:g}$", fontsize=9)
    marks = [
        Line2D([], [], color="#777777", ls="none", marker="o", ms=4, mfc=fill, label=leg)
        for leg, fill in zip(LEGS, ("#777777", "white"), strict=True)
    ]
    lines = {words: line for words, (_, line) in limits.items()}
    keys = style.key({_ratio_words(share): color for share, color in colours.items()}, lines)
    axes[0].legend(handles=[*keys, *marks], loc="upper left")
    style.letters(axes)
    return pd.concat(rows)


def _pull_offs(panel: Axes, one: xr.Dataset, color: str) -> pd.DataFrame:
    """Pull-off on loading and on unloading against work, with grid errors as bars."""
    shown = pd.DataFrame({"work_of_separation": one.work_of_separation.values})
    for leg, fill in zip(LEGS, (color, "white"), strict=True):
        name = f"pull_off_load_{leg}"
        shown[name] = one[name].values
        error = one.get(f"{name}_grid_error")
        shown[f"{name}_grid_error"] = np.nan if error is None else error.values
        bars = curves.normalised(shown[f"{name}_grid_error"], one) if error is not None else None
        look = {"color": color, "marker": "o", "ms": 4, "mfc": fill, "lw": 0.7 if fill == color else 0.0}
        panel.errorbar(shown.work_of_separation, curves.normalised(shown[name], one), bars, elinewidth=0.8, **look)
    return shown


def stress_field(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Stress in the layer under the contact at the largest approach, with friction (Section 2.2)."""
    one = data.sel(work_of_separation=REFERENCE_WORK, work_ratio=1.0).isel(member=0)
    here = one.sel(snapshot=INDENTED, method="nearest", tolerance=style.SAME)
    body = elastic(curves.settings(one)["body"])
    grid = Grid((one.x.size,), (float(one.length),))
    shift = one.x.size // 2 - int(np.argmax(here.heights.values))
    traction = np.stack([np.roll(here[f"{name}_traction"].values, shift) for name in ("normal", "tangential")])
    reach = 1.2 * float(one.final_repulsive_length)
    middle = grid.positions()[one.x.size // 2]
    found = inside(body, grid, traction, _depths(reach)).between(middle - reach, middle + reach)
    return stress.draw(replace(found, position=found.position - middle), axes)


def _depths(reach: float) -> Array:
    return np.linspace(0.0, reach, 81)
