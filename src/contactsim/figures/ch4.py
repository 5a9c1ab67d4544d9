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

from contactsim import reference
from contactsim.elasticity.subsurface import inside
from contactsim.figures import style
from contactsim.figures.parts import asperities, stress
from contactsim.figures.parts import load_curves as curves
from contactsim.grid import Array, Grid
from contactsim.observables.adhesion import LEGS
from contactsim.study.scenes import build_elasticity

APPROACHING = -5.0
"""Approach (nm), before the contact is closed, at which fields are kept."""
REFERENCE_WORK = 2.0
"""Work of separation, N/m, of the figures for which the thesis names one."""


def fig_4_2(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Normal traction at the largest approach with and without friction, for two works (thesis Fig. 4.2)."""
    rows = []
    for panel, work in zip(axes, (REFERENCE_WORK, 0.8), strict=True):
        parts = [data.sel(work_of_separation=work, work_ratio=ratio) for ratio in (0.0, 1.0)]
        rows.append(asperities.profiles(panel, parts, work).assign(work_of_separation=work))
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
        rows.append(asperities.profiles(panel, parts, REFERENCE_WORK).assign(case=words.replace("$", "")))
        panel.set_title(words, fontsize=9)
    style.letters(axes)
    return pd.concat(rows)


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
    shown = (right, "reference", [data.sel(work_of_separation=REFERENCE_WORK)], works[REFERENCE_WORK], "-")
    others = [
        (right, r"$\nu=0.45$", soft, style.WHOLE, "--"),
        (right, r"$w/R=0.08$", [close], style.PAIRS, ":"),
        (right, r"$h/R=0.8$", [thick], style.EXACT, "-."),
    ]
    rows = []
    for panel, words, parts, color, line in [*cases, shown, *others]:
        sizes = asperities.sizes(parts)
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


def fig_4_5(data: xr.Dataset, uncoupled: xr.Dataset, pulled: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Load against approach by the coupled and the uncoupled law, frictionless (thesis Fig. 4.5)."""
    smooth = data.sel(work_ratio=0.0)
    works = style.shades(uncoupled.work_of_separation.values)
    ratios = style.shades(uncoupled.poisson_ratio.values)
    rows = []
    for work, color in works.items():
        pair = smooth.sel(work_of_separation=work), uncoupled.sel(work_of_separation=work, poisson_ratio=0.3)
        rows += [asperities.both_legs(axes[::2], pair, color, "a", work_of_separation=work, poisson_ratio=0.3)]
    for ratio, color in ratios.items():
        bodies = [one for one in (pulled, smooth.expand_dims(poisson_ratio=[0.3])) if ratio in one.poisson_ratio]
        with_friction = bodies[0].sel(poisson_ratio=ratio, work_of_separation=REFERENCE_WORK)
        if "work_ratio" in with_friction.dims:
            with_friction = with_friction.sel(work_ratio=0.0)
        pair = with_friction, uncoupled.sel(work_of_separation=REFERENCE_WORK, poisson_ratio=ratio)
        rows += [
            asperities.both_legs(axes[1::2], pair, color, "b", work_of_separation=REFERENCE_WORK, poisson_ratio=ratio)
        ]
    colours = {rf"$\varphi_n={work:g}$ N/m": color for work, color in works.items()}
    axes[0].legend(handles=style.key(colours, asperities.COUPLING), loc="upper left")
    axes[1].legend(
        handles=style.key({rf"$\nu={r:g}$": color for r, color in ratios.items()}, asperities.COUPLING),
        loc="upper left",
    )
    fixed = r"$\nu=0.3$", rf"$\varphi_n={REFERENCE_WORK:g}$ N/m"
    asperities.load_axes(axes, tuple(f"{leg}, {words}" for leg in LEGS for words in fixed))
    return pd.concat(rows)


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
            words = f"{asperities.ratio_words(ratio)}: pull-off {pull:.1f} N/m at {at:.2f} nm"
            shown = curves.branch(panel, one, leg, color=color, ls=asperities.friction(ratio), lw=1.1, label=words)
            rows.append(shown.assign(work_ratio=ratio, leg=leg))
    for panel in axes:
        panel.legend(loc="upper left")
    asperities.load_axes(axes, LEGS)
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
            rows.append(asperities.pull_offs(panel, one, color).assign(poisson_ratio=ratio, work_ratio=share))
        modulus = curves.settings(pulled)["body"]["youngs_modulus"] / (1 - ratio**2)
        first = float(
            curves.normalised(body.pull_off_load_loading.isel(work_of_separation=0).sel(work_ratio=0.0), body)
        )
        limits = {
            rf"$\bar\varphi_n^{{{'2/3' if np.isclose(slope, 2 / 3, atol=1e-3) else f'{slope:g}'}}}$": (
                first * (dense / works[0]) ** slope,
                ":",
            ),
            "JKR, half-space": (curves.normalised(reference.cylinder_pull_off(dense, radius, modulus), body), "-"),
            "rigid": (
                curves.normalised(reference.rigid_cylinder_pull_off(dense, radius, curves.normal_length(body)), body),
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
    keys = style.key({asperities.ratio_words(share): color for share, color in colours.items()}, lines)
    axes[0].legend(handles=[*keys, *marks], loc="upper left")
    style.letters(axes)
    return pd.concat(rows)


def stress_field(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Stress in the layer under the contact at the largest approach, with friction (Section 2.2)."""
    one = data.sel(work_of_separation=REFERENCE_WORK, work_ratio=1.0).isel(member=0)
    here = one.sel(snapshot=asperities.INDENTED, method="nearest", tolerance=style.SAME)
    body = build_elasticity(curves.settings(one)["body"])
    grid = Grid((one.x.size,), (float(one.length),))
    shift = one.x.size // 2 - int(np.argmax(here.heights.values))
    traction = np.stack([np.roll(here[f"{name}_traction"].values, shift) for name in ("normal", "tangential")])
    reach = 1.2 * float(one.final_contact_length)
    middle = grid.positions()[one.x.size // 2]
    found = inside(body, grid, traction, _depths(reach)).between(middle - reach, middle + reach)
    return stress.draw(replace(found, position=found.position - middle), axes)


def _depths(reach: float) -> Array:
    return np.linspace(0.0, reach, 81)
