"""Chapter 6: frictional sliding. Each function draws one figure and returns the numbers that it shows.

As in the thesis forces are over the period and a modulus of 70 GPa, lengths over the period; of flats, whose period is
of no consequence, slides are in nm. Values of the thesis, from `reference` in the config, come as keywords.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim import dataset, reference
from contactsim.figures import ch2, style
from contactsim.figures.parts import slide_curves as curves
from contactsim.observables.adhesion import contact_length
from contactsim.observables.sliding import EVENT

LATTICES = (1.0, 1.5, 2.0, 2.44, 4.88)
"""Lattice constants, over δt, whose sums of springs Fig. 6.3c shows."""
SAWTOOTH = ((70.0, 0.1), (140.0, 0.1), (70.0, 0.05))
SMOOTH = ((70.0, 0.01), (70.0, 0.005), (400.0, 0.05))
"""Young's modulus (GPa) and ratio of works of the curves of Figs 6.4a and 6.4b."""
CASES = {"I": (-2.0, 0), "II": (5.0, 0), "III": (5.0, 1)}
"""Approach (nm) of the cases of Fig. 6.7, and which of the two studies they are of."""
STAGES = "ABCDE"
THICK, THIN = 2.6, 0.7
"""Lines of the first and the last of values whose curves may cover each other."""


def fig_6_3(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Tractions of a spring (thesis Fig. 6.3), and what springs to a whole lattice add up to (beyond it)."""
    shown = ch2.fig_2_2(data, axes[:2])
    places = np.linspace(0.0, 1.0, 401)
    for lattice, colour in style.shades(LATTICES).items():
        total = reference.spring_sum(places * lattice, lattice)[1]
        axes[2].plot(places, total, color=colour, lw=1.2, label=rf"$l/\delta_t={lattice:g}$")
        rows = {"component": "tangential", "fixed_gap": 0.0, "gap": places * lattice, "traction": total}
        shown = pd.concat([shown, pd.DataFrame(rows | {"lattice_constant": lattice})])
    axes[2].axhline(0.0, color=style.EXACT, lw=0.5)
    axes[2].set(xlabel=r"$\Delta_t/l$", ylabel=r"$\Sigma T_t\,\delta_t/\varphi_t$ at $\Delta_n=0$", xlim=(0, 1))
    axes[2].legend(loc="upper right")
    style.letter(axes[2], "c")
    return shown


def fig_6_4(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Force against slide of flats, stick-slip and smooth, with the exact answer (thesis Fig. 6.4)."""
    rows = []
    work = dataset.settings_of(data)["cohesive_zone"]["work_of_separation"]
    for panel, cases in zip(axes, (SAWTOOTH, SMOOTH), strict=True):
        known = [one for one in cases if one[0] in data.counter_body_youngs_modulus and one[1] in data.work_ratio]
        for (modulus, ratio), colour in zip(known, style.shades(range(len(known))).values(), strict=True):
            one = data.sel(counter_body_youngs_modulus=modulus, work_ratio=ratio).isel(member=0)
            curve = curves.curve(one)
            words = rf"$\bar E={modulus:g}$, $\bar\varphi_t={ratio * work:g}$"
            panel.plot(curve.slide, curve.force, color=colour, lw=1.1, label=words)
            exact = curves.exact_flat(one, curve.slide.values)
            panel.plot(curve.slide[::4], exact[::4], ".", color=style.EXACT, ms=1.6, zorder=3)
            rows.append(curve.assign(exact=exact, youngs_modulus=modulus, tangential_work=ratio * work))
        apart = max(float(np.abs(one.force - one.exact).max() / one.exact.max()) for one in rows[-len(known) :])
        words = f"exact, one degree of freedom\n(apart by {apart:.0e} of the force at most)"
        panel.plot([], [], ".", color=style.EXACT, ms=3, label=words)
        panel.axhline(0.0, color=style.EXACT, lw=0.5)
        panel.set(xlabel=r"$U_x$ (nm)", ylabel=curves.FORCE)
        curves.headroom(panel, 0.6)
        panel.legend(loc="upper left")
    style.letters(axes)
    return pd.concat(rows)


def fig_6_5(thin: xr.Dataset, thick: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Mean friction of flats against modulus over strength, for two thicknesses (thesis Fig. 6.5)."""
    rows = []
    for data, colour in zip((thin, thick), (style.CONTACT, style.WHOLE), strict=True):
        one, known = data.isel(member=0), dataset.settings_of(data)
        law, body = known["cohesive_zone"], known["counter_body"]
        work, length, thickness = (
            law["work_of_separation"] * law["work_ratio"],
            law["tangential_length"],
            body["thickness"],
        )
        strength = reference.tangential_strength(work, length, 0.0)
        fall = reference.steepest_fall(known["pairing"]["lattice_constant"], length) * work / length**2
        critical = 2 * (1 + body["poisson_ratio"]) * thickness * fall / strength
        ratio, scale = one.counter_body_youngs_modulus.values / strength, 1 / (float(one.length) * curves.MODULUS)
        for name, fill, line in (("mean_friction", colour, "-"), ("average_friction", "white", "--")):
            words = rf"$h={thickness:g}$ nm" if name == "mean_friction" else None
            error = scale * one[f"{name}_increment_error"].values
            look = {"color": colour, "mfc": fill, "ms": 3.5, "lw": 0.9, "elinewidth": 0.8, "capsize": 1.5}
            axes.errorbar(ratio, scale * one[name].values, error, fmt="o", ls=line, label=words, **look)
        shown = {name: scale * one[name].values for name in ("mean_friction", "average_friction")}
        rows.append(
            pd.DataFrame({"modulus_over_strength": ratio} | shown | {"slip_count": one.slip_count.values}).assign(
                thickness=thickness, critical=critical
            )
        )
        if critical < ratio.max():
            axes.axvspan(critical, 1.3 * ratio.max(), color=colour, alpha=0.12, lw=0)
            axes.axvline(critical, color=colour, lw=0.8, ls=":")
            axes.text(
                1.04 * critical,
                0.97,
                f"smooth at\n$h={thickness:g}$ nm",
                transform=axes.get_xaxis_transform(),
                fontsize=7,
                va="top",
                color=colour,
            )
    handles = style.key({}, {r"$(F_s+F_k)/2$ (Eq. 6.7)": "-", "mean over whole periods": "--"})
    axes.set(xscale="log", xlabel=r"$E/\tau_{\max}$", ylabel=r"friction $\langle\bar F\rangle$")
    axes.axhline(0.0, color=style.EXACT, lw=0.5)
    axes.legend(handles=[*axes.get_legend_handles_labels()[0], *handles], loc="lower left")
    return pd.concat(rows)


def fig_6_6(data: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Tangential and normal force, and contact length, of the probe against its slide (thesis Fig. 6.6)."""
    one = data.sel(slide_approach=0.0).isel(member=0)
    curve, slips = curves.curve(one), one[list(EVENT)].dropna("event", how="all")
    axes.plot(curve.relative_slide, curve.force, color=style.CONTACT, lw=1.2, label=r"$\bar F$")
    axes.plot(curve.relative_slide, curve.load, color=style.CONTACT, lw=1.2, ls="--", label=r"$\bar L$")
    axes.axhline(0.0, color=style.EXACT, lw=0.5)
    for place in slips.event_sliding_distance.values:
        axes.axvline(place / float(one.length), color="#999999", lw=0.5, ls=":")
    axes.set(xlabel=curves.SLIDE, ylabel=r"$\bar F$, $\bar L$")
    area = axes.twinx()
    area.plot(curve.relative_slide, curve.area, color=style.WHOLE, lw=1.2, ls=":", label=r"$\bar A$")
    area.set_ylabel(curves.AREA, color=style.WHOLE)
    area.set_ylim(0, 1.5 * curve.area.max())
    handles = axes.get_legend_handles_labels()[0] + area.get_legend_handles_labels()[0]
    axes.legend(handles=handles, loc="upper left", ncols=3)
    return curve


def fig_6_7(data: xr.Dataset, slippery: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Contact length against slide for three cases, and where the contact is at stages A to E (thesis Fig. 6.7)."""
    rows, left, right = [], *axes
    for (name, (approach, which)), colour in zip(CASES.items(), (style.CONTACT, style.EXACT, style.WHOLE), strict=True):
        one = (data, slippery)[which].sel(slide_approach=approach).isel(member=0)
        curve, ratio = curves.curve(one), dataset.settings_of((data, slippery)[which])["cohesive_zone"]["work_ratio"]
        words = rf"{name}: $\bar\delta={approach / curves.START:g}$, $\varphi_t/\varphi_n={ratio:g}$"
        left.plot(curve.relative_slide, curve.area, color=colour, lw=1.1, label=words)
        stages = curves.stages(one, curve)
        left.plot(curve.relative_slide.iloc[stages], curve.area.iloc[stages], "o", color=colour, ms=3.5, mfc="white")
        for place, (stage, step) in enumerate(zip(STAGES, stages, strict=True)):
            here = curve.iloc[step]
            beside = (2, -9) if stage == "D" else (2, 3)
            left.annotate(stage, (here.relative_slide, here.area), beside, textcoords="offset points", fontsize=6.5)
            at = place + 6 * list(CASES).index(name)
            right.plot([at, at], [here.trailing, here.leading], color=colour, lw=5, solid_capstyle="butt")
            rows.append({"case": name, "stage": stage, "slide": here.slide} | here[["area", "force"]].to_dict())
            rows[-1] |= {"trailing": here.trailing, "leading": here.leading}
        first = curve.iloc[0]
        for edge in (first.trailing, first.leading):
            right.plot(np.array([-0.5, 4.5]) + 6 * list(CASES).index(name), [edge] * 2, color=colour, lw=0.6, ls=":")
    ticks = [place + 6 * case for case, place in product(range(len(CASES)), range(len(STAGES)))]
    right.set_xticks(ticks, list(STAGES) * len(CASES))
    right.tick_params(axis="x", top=False)
    right.set(ylabel="contact, $x/w$ of the undeformed probe")
    right.text(0.02, 0.02, "trailing", transform=right.transAxes, fontsize=7)
    right.text(0.02, 0.95, "leading", transform=right.transAxes, fontsize=7)
    left.set(xlabel=curves.SLIDE, ylabel=curves.AREA)
    curves.headroom(left, 0.3)
    left.legend(loc="upper right")
    style.letters(axes)
    return pd.DataFrame(rows)


def fig_6_8(data: xr.Dataset, weak: xr.Dataset, slippery: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Contact length against force to the onset with Eq. 6.8, and at the onset with Eq. 6.9 (thesis Fig. 6.8)."""
    rows, (left, right) = [], axes
    for approach, colour in style.shades(data.slide_approach.values).items():
        one = data.sel(slide_approach=approach).isel(member=0)
        curve, period = curves.curve(one), float(one.length)
        part = curve[curve.slide <= float(one.onset_sliding_distance) + 1e-9]
        left.plot(part.force, part.area, ".", color=colour, ms=2.2, label=rf"$\bar\delta={approach / curves.START:g}$")
        force = part.force.values * period * curves.MODULUS
        fit = (float(one.initial_contact_length) - float(one.quadratic_coefficient) * force**2) / period
        left.plot(part.force, np.maximum(fit, 0.0), color=colour, lw=0.8)
        left.plot(part.force.iloc[-1], part.area.iloc[-1], "o", color="black", ms=3.5)
        rows.append(part[["force", "area"]].assign(approach=approach, fit=fit, study="a"))
    left.set(xlabel=curves.FORCE, ylabel=curves.AREA)
    curves.headroom(left, 0.3)
    left.legend(loc="upper right", ncols=3, fontsize=6.5)
    for other, colour, mark in ((data, "black", "o"), (weak, style.WHOLE, "s"), (slippery, style.CONTACT, "^")):
        law, one = dataset.settings_of(other)["cohesive_zone"], other.isel(member=0)
        period = float(other.length.max())
        area, scale = one.onset_contact_length / period, 1 / (period * curves.MODULUS)
        force = one.static_friction * scale
        words = rf"$\bar\varphi_n={law['work_of_separation']:g}$, $\varphi_t/\varphi_n={law['work_ratio']:g}$"
        right.plot(area, force, mark, color=colour, ms=4, mfc="none", label=words)
        strength, offset = float(one.shear_strength), float(one.friction_without_contact)
        ends = np.array([0.0, float(area.max())])
        right.plot(ends, strength * ends / curves.MODULUS + offset * scale, color=colour, lw=0.8)
        shown = {"force": force.values, "area": area.values, "approach": one.slide_approach.values, "study": words}
        rows.append(pd.DataFrame(shown).assign(shear_strength=strength / curves.MODULUS, offset=offset * scale))
    right.set(xlabel=r"$\bar A_s$", ylabel=r"$\bar F_s$")
    right.legend(loc="upper left")
    right.set_ylim(bottom=0.0)
    curves.headroom(right, 0.25)
    style.letters(axes)
    return pd.concat(rows)


def peel_and_slip(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """The gap under the probe, and force and contact length as they grow with the slide (beyond the thesis)."""
    one = data.isel(member=0)
    curve, now = curves.curve(one), one.isel(snapshot=-1)
    order = (np.arange(one.x.size) + one.x.size // 2) % one.x.size
    place = (np.arange(one.x.size) - one.x.size // 2) / one.x.size
    peak = int(np.argmax(one.heights.values))
    gap, slip = (now[name].values[(order + peak) % one.x.size] for name in ("normal_gap", "tangential_gap"))
    axes[0].plot(place, gap, color=style.EXACT, lw=1.0)
    axes[0].fill_between(place, gap, 0.0, where=gap < 0, color=style.CONTACT, alpha=0.6, lw=0)
    axes[0].axhline(0.0, color=style.WHOLE, lw=0.6)
    axes[0].set(xlabel="$x/w$ of the undeformed probe", ylabel="gap (nm); filled: contact", xlim=(-0.1, 0.1))
    axes[0].set_ylim(-0.6, 3.0)
    axes[1].plot(place, slip, color=style.PAIRS, lw=1.0)
    axes[1].set(xlabel="$x/w$ of the undeformed probe", ylabel="tangential gap (nm)", xlim=(-0.1, 0.1), ylim=(-1, 12))
    for panel, name, colour, words in zip(
        axes[2:], ("force", "area"), (style.CONTACT, style.WHOLE), (curves.FORCE, curves.AREA), strict=True
    ):
        panel.plot(curve.slide, curve[name], color=colour, lw=1.1)
        panel.plot(curve.slide.iloc[-1], curve[name].iloc[-1], "o", color=colour, ms=4)
        panel.set(xlabel=r"$U_x$ (nm)", ylabel=words)
    size = contact_length(now.normal_gap.values, float(one.length) / one.x.size)
    axes[0].set_title(rf"$U_x={float(now.snapshot):g}$ nm, contact {size:.0f} nm", fontsize=9)
    return curve


def friction_loop(data: xr.Dataset, loaded: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Force and contact length of the probe sliding to and fro, at given approaches and loads (beyond the thesis)."""
    rows = []
    for name, other, row in (("slide_approach", data, axes[:2]), ("slide_mean_pressure", loaded, axes[2:])):
        for value, colour in style.shades(other[name].values).items():
            one = other.sel({name: value}).isel(member=0)
            curve = curves.curve(one)
            bar = rf"$\delta={value:g}$ nm" if name == "slide_approach" else rf"$p={value:g}$ GPa"
            row[0].plot(curve.relative_slide, curve.force, color=colour, lw=0.9, label=bar)
            row[1].plot(curve.relative_slide, curve.area, color=colour, lw=0.9)
            rows.append(curve.assign(held=name, value=value, loop_energy=float(one.loop_energy)))
        row[0].axhline(0.0, color=style.EXACT, lw=0.5)
        row[0].set(xlabel=curves.SLIDE, ylabel=curves.FORCE)
        row[1].set(xlabel=curves.SLIDE, ylabel=curves.AREA)
        curves.headroom(row[0], 0.3)
        row[0].legend(loc="upper left", ncols=2)
    style.letters(axes)
    return pd.concat(rows)


def open_choices(
    width: xr.Dataset,
    height: xr.Dataset,
    lattice: xr.Dataset,
    window: xr.Dataset,
    depth: xr.Dataset,
    damping: xr.Dataset,
    axes: list[Axes],
) -> pd.DataFrame:
    """Force of the probe for what the thesis leaves open: cell, layer, lattice, window, cut, damping."""
    rows = []
    for panel, other in zip(axes, (width, height, lattice, window, depth, damping), strict=True):
        (name,) = dataset.settings_of(other)["vary"]
        dim, words = dataset.dimension(name), name.rpartition(".")[2].replace("_", " ")
        for value, colour in style.shades(other[dim].values).items():
            one = other.sel({dim: value}).isel(member=0)
            curve = curves.curve(one)
            wide = np.linspace(THICK, THIN, other[dim].size)[len(panel.lines)]
            panel.plot(curve.slide, curve.force * float(one.length), color=colour, lw=wide, label=f"{value:g}")
            numbers = {
                key: float(one[key])
                for key in ("static_friction", "peeled_fraction", "reattached_fraction", "first_slip_periods")
            }
            rows.append(pd.DataFrame([numbers | {"choice": words, "value": float(value)}]))
        panel.set(xlabel=r"$U_x$ (nm)", ylabel=r"$F/E$ (nm)")
        curves.headroom(panel, 0.35)
        unit = other[dim].attrs["units"]
        panel.legend(title=words if unit == "1" else f"{words} ({unit})", loc="upper left", ncols=3, fontsize=6.5)
    style.letters(axes)
    return pd.concat(rows)


def rough_slide_forces(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Forces and contact of a rough surface sliding over a flat, and its gap before (beyond the thesis)."""
    one = data.isel(member=0)
    curve, before = curves.curve(one), one.sel(snapshot=0.0, method="nearest", tolerance=style.SAME)
    axes[0].plot(one.x / one.length, before.normal_gap, color=style.EXACT, lw=0.8)
    axes[0].fill_between(one.x / one.length, before.normal_gap, 0.0, where=before.normal_gap < 0, color=style.CONTACT)
    axes[0].set(xlabel="$x/w$", ylabel="gap at $U_x=0$ (nm)")
    axes[1].plot(curve.slide, curve.force, color=style.CONTACT, lw=1.0, label=r"$\bar F$")
    axes[1].plot(curve.slide, curve.load, color=style.CONTACT, lw=1.0, ls="--", label=r"$\bar L$")
    axes[1].axhline(0.0, color=style.EXACT, lw=0.5)
    axes[1].set(xlabel=r"$U_x$ (nm)", ylabel=r"$\bar F$, $\bar L$")
    axes[1].legend(loc="best")
    axes[2].plot(curve.slide, curve.area, color=style.WHOLE, lw=1.0)
    axes[2].set(xlabel=r"$U_x$ (nm)", ylabel=curves.AREA)
    style.letters(axes)
    return curve


def footer(data: xr.Dataset) -> str:
    """Of the law by itself: nothing is simulated."""
    return ch2.footer(data)
