"""Chapter 6: frictional sliding. Each function plots one figure and returns the numbers that it shows.

As in the thesis forces are over the period and a modulus of 70 GPa, lengths over the period. The period of flats is
arbitrary, so their sliding distances are in nm.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.analysis import slide_tables
from contactsim.analysis.scales import LawScales, lattice_constant
from contactsim.analysis.slide_tables import slide_table
from contactsim.figures import style
from contactsim.figures.parts import flats, law_curves
from contactsim.figures.parts import slide_curves as curves
from contactsim.observables.sliding import EVENT
from contactsim.reference import springs

LATTICES = (1.0, 1.5, 2.0, 2.44, 4.88)
"""Lattice constants over δt of Fig. 6.3c."""
STICK_SLIP = ((70.0, 0.1), (140.0, 0.1), (70.0, 0.05))
SMOOTH = ((70.0, 0.01), (70.0, 0.005), (400.0, 0.05))
"""Young's modulus (GPa) and ratio of works of the curves of Figs 6.4a and 6.4b."""
VARIED = (("o", 5.5, "$E$ varied"), ("x", 3.2, r"$\varphi_t$ varied, $E=70$ GPa"))
"""Marker, its size and label of what is varied in Fig. 6.5b: the small one fits into the large one."""
CASES = {"I": (-2.0, 0), "II": (5.0, 0), "III": (5.0, 1)}
"""Approach (nm) of the cases of Fig. 6.7, and which of the two studies they belong to."""
WEAK, SLIPPERY = style.WHOLE, style.BROWN
"""Colours of the probe with weak adhesion and of that with low friction."""


def fig_6_3(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot tractions of a spring (thesis Fig. 6.3), and the sum over a lattice of springs (beyond it)."""
    tables = [law_curves.plot_tractions(data, axes[:2])]
    places = np.linspace(0.0, 1.0, 401)
    for lattice, colour in style.shades(LATTICES).items():
        _, tangential = springs.spring_sum(places * lattice, lattice)
        axes[2].plot(places, tangential, color=colour, lw=1.2, label=rf"$l/\delta_t={lattice:g}$")
        curve = pd.DataFrame({"component": "tangential", "fixed_gap": 0.0, "gap": places * lattice})
        tables.append(curve.assign(traction=tangential, lattice_constant=lattice))
    axes[2].axhline(0.0, **style.ZERO)
    axes[2].set(xlabel=r"$\Delta_t/l$", ylabel=r"$\Sigma T_t\,\delta_t/\varphi_t$ at $\Delta_n=0$", xlim=(0, 1))
    axes[2].legend(loc="upper right")
    style.add_letters(axes)
    return pd.concat(tables)


def fig_6_4(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the force of flats against the sliding distance, stick-slip and smooth (thesis Fig. 6.4).

    Dots: the exact answer.
    """
    tables = []
    for panel, cases in zip(axes, (STICK_SLIP, SMOOTH), strict=True):
        simulated = [
            (modulus, ratio)
            for modulus, ratio in cases
            if modulus in data.counter_body_youngs_modulus and ratio in data.work_ratio
        ]
        curves_of_panel = [
            flats.plot_flat(panel, data.sel(counter_body_youngs_modulus=modulus, work_ratio=ratio), colour)
            for (modulus, ratio), colour in zip(simulated, style.shades(range(len(simulated))).values(), strict=True)
        ]
        error = max(float(np.abs(curve.force - curve.exact).max() / curve.exact.max()) for curve in curves_of_panel)
        label = f"exact, one degree of freedom\n(largest difference {100 * error:.1g} %)"
        panel.plot([], [], ".", color=style.EXACT, ms=3, label=label)
        panel.plot([], [], color=style.EXACT, lw=0.7, ls=":", label=flats.prandtl_tomlinson_label(data))
        panel.axhline(0.0, **style.ZERO)
        flats.mark_periods(panel, lattice_constant(data), float(curves_of_panel[0].slide.max()))
        panel.set(xlabel=curves.SLIDE_NM, ylabel=curves.FORCE)
        style.add_headroom(panel, 0.95)
        panel.legend(loc="upper left")
        tables += curves_of_panel
    style.add_letters(axes)
    return pd.concat(tables)


def fig_6_5(
    thin: xr.Dataset, thick: xr.Dataset, weaker: xr.Dataset, weaker_thick: xr.Dataset, axes: list[Axes]
) -> pd.DataFrame:
    """Plot the mean friction of flats against modulus over strength (thesis Fig. 6.5), and the same over the strength.

    Weaker interfaces lie on the curves of stiffer layers of their thickness.
    """
    tables, ends = [], []
    for studies in ((thin, weaker), (thick, weaker_thick)):
        by_modulus, by_work = (slide_tables.friction_against_modulus(data) for data in studies)
        thickness, critical = by_modulus.thickness.iloc[0], by_modulus.critical.iloc[0]
        colour = style.variable_colours("thickness", thickness)[float(thickness)]
        largest = max(table.modulus_over_strength.max() for table in (by_modulus, by_work))
        flats.plot_friction(axes[0], by_modulus, colour, rf"$h={thickness:g}$ nm")
        for table, (marker, size, words) in zip((by_modulus, by_work), VARIED, strict=True):
            look = style.marker_look(colour, marker, size, fill="none")
            look |= {"label": rf"_$h={thickness:g}$ nm, {words}"}
            axes[1].plot(table.modulus_over_strength, table.relative_friction, ls="none", **look)
        ratios = np.geomspace(by_modulus.modulus_over_strength.min(), largest, 60)
        sine = slide_tables.friction_by_prandtl_tomlinson(studies[0], ratios)
        axes[1].plot(ratios, sine, color=colour, lw=0.8, ls=":", label=rf"_$h={thickness:g}$ nm, Prandtl–Tomlinson")
        ends.append((critical, largest, thickness, colour))
        errors = ["mean_friction_increment_error", "average_friction_increment_error"]
        tables += [table.drop(columns=errors) for table in (by_modulus, by_work)]
    _label_friction(axes, thin, [colour for *_, colour in ends])
    right = 1.3 * max(largest for _, largest, *_ in ends)
    for critical, largest, thickness, colour in ends:
        if critical < largest:
            flats.shade_smooth(axes[0], critical, right, thickness, colour)
    axes[0].set_xlim(right=right)
    return pd.concat(tables)


def _label_friction(axes: list[Axes], thin: xr.Dataset, colours: list[str]) -> None:
    """Add labels and legends to the panels of friction against modulus over strength; colours: of each thickness."""
    lines = style.line_handles({r"$(F_s+F_k)/2$ (Eq. 6.7)": "-", "mean over whole periods": "--"})
    axes[0].set(xscale="log", xlabel=r"$E/\tau_{\max}$", ylabel=r"friction $\langle\bar F\rangle$")
    axes[1].set(xscale="log", xlabel=r"$E/\tau_{\max}$", ylabel=r"$\langle F\rangle/(w\tau_{\max})$")
    for panel in axes:
        panel.axhline(0.0, **style.ZERO)
    style.add_headroom(axes[0], 0.35)
    thicknesses = axes[0].get_legend_handles_labels()
    axes[0].legend(handles=[*thicknesses[0], *lines], loc="upper right", ncols=2)
    for label, colour in zip(thicknesses[1], colours, strict=True):
        axes[1].plot([], [], color=colour, lw=1.5, label=label)
    for marker, size, label in VARIED:
        axes[1].plot([], [], ls="none", label=label, **style.marker_look(style.EXACT, marker, size, fill="none"))
    axes[1].plot([], [], color=style.EXACT, lw=0.8, ls=":", label=flats.prandtl_tomlinson_label(thin))
    style.add_headroom(axes[1], 0.55)
    axes[1].legend(loc="upper right")
    style.add_letters(axes)


def fig_6_6(data: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Plot forces and contact length of the probe against its sliding distance (thesis Fig. 6.6).

    Dotted lines: slips.
    """
    path = data.sel(slide_approach=0.0).isel(member=0)
    table, slips = slide_table(path), path[list(EVENT)].dropna("event", how="all")
    curves.plot_forces(axes, table.relative_slide, table, 1.2)
    for number, slide in enumerate(slips.event_sliding_distance.values, 1):
        axes.axvline(slide / float(path.length), color=style.LIGHT_GREY, lw=0.5, ls=":", label=f"_slip {number}")
    axes.set(xlabel=curves.SLIDE)
    area = axes.twinx()
    area.plot(table.relative_slide, table.area, color=style.GREY, lw=1.2, ls=":", label=r"$\bar A$")
    area.set_ylabel(curves.AREA, color=style.GREY)
    area.set_ylim(0, 1.5 * table.area.max())
    handles = axes.get_legend_handles_labels()[0] + area.get_legend_handles_labels()[0]
    axes.legend(handles=handles, loc="upper left", ncols=3)
    return table


def fig_6_7(data: xr.Dataset, slippery: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the contact against the sliding distance, and its place at stages A to E (thesis Fig. 6.7)."""
    path_axes, stage_axes = axes
    tables = []
    approaches = style.shades(data.slide_approach)
    for number, (name, (approach, study)) in enumerate(CASES.items()):
        colour = SLIPPERY if study else approaches[approach]
        path = (data, slippery)[study].sel(slide_approach=approach).isel(member=0)
        label = f"{name}: {curves.approach_label(approach)}, {curves.work_ratio_label(path)}"
        tables.append(curves.plot_stages(path_axes, stage_axes, path, label, colour, number).assign(case=name))
    curves.label_stages(stage_axes, list(CASES))
    path_axes.set(xlabel=curves.SLIDE, ylabel=curves.AREA)
    style.add_headroom(path_axes, 0.3, 0.05)
    path_axes.legend(loc="upper right")
    style.add_letters(axes)
    return pd.concat(tables)[["case", "stage", "slide", "area", "force", "trailing", "leading"]]


def fig_6_8(data: xr.Dataset, weak: xr.Dataset, slippery: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot contact against force to the onset with Eq. 6.8, and at the onset with Eq. 6.9 (thesis Fig. 6.8)."""
    path_axes, onset_axes = axes
    tables = []
    for approach, colour in style.shades(data.slide_approach).items():
        path = data.sel(slide_approach=approach).isel(member=0)
        table = slide_tables.contact_to_onset(path)
        name = f"_{curves.approach_label(approach)}"
        path_axes.plot(table.force[::5], table.area[::5], ".", color=colour, ms=1.6, label=f"{name}, computed")
        label = rf"{curves.approach_label(approach)}, $R^2={float(path.quadratic_r_squared):.3f}$"
        path_axes.plot(table.force, np.maximum(table.fit, 0.0), color=colour, lw=1.0, label=label)
        path_axes.plot(table.force, table.crack, color=colour, lw=0.7, ls=":", label=f"{name}, crack of both modes")
        onset = {"color": style.EXACT, "ms": 3.5, "label": f"{name}, onset"}
        path_axes.plot(table.force.iloc[-1], table.area.iloc[-1], "o", **onset)
        tables.append(table.assign(approach=approach, study="a", quadratic=float(path.quadratic_coefficient)))
    path_axes.set(xlabel=curves.FORCE, ylabel=curves.AREA)
    path_axes.plot([], [], color=style.EXACT, lw=0.7, ls=":", label="crack of both modes")
    style.add_headroom(path_axes, 0.6)
    path_axes.legend(loc="upper right", ncols=2, fontsize=7)
    for study, colour, marker in ((data, style.EXACT, "o"), (weak, WEAK, "s"), (slippery, SLIPPERY, "^")):
        tables.append(_plot_onsets(onset_axes, study, colour, marker))
    onset_axes.plot([], [], color=style.EXACT, lw=0.7, ls=":", label=r"$\bar\tau_c\bar A_s$ alone (Bowden–Tabor)")
    onset_axes.set(xlabel=r"$\bar A_s$", ylabel=r"$\bar F_s$")
    onset_axes.legend(loc="upper left")
    onset_axes.set_ylim(bottom=0.0)
    style.add_headroom(onset_axes, 0.25)
    style.add_letters(axes)
    columns = ["force", "area", "approach", "fit", "crack", "quadratic", "study", "shear_strength", "offset"]
    return pd.concat(tables)[columns]


def _plot_onsets(axes: Axes, data: xr.Dataset, colour: str, marker: str) -> pd.DataFrame:
    """Plot the force at the onset against the contact, with the straight line of Eq. 6.9."""
    table = slide_tables.onset_table(data)
    label = rf"$\bar\varphi_n={LawScales.of(data).work_of_separation:g}$, {curves.work_ratio_label(data)}"
    axes.plot(table.area, table.force, ls="none", label=label, **style.marker_look(colour, marker, fill="none"))
    ends = np.array([0.0, float(table.area.max())])
    strength, offset = table.shear_strength.iloc[0], table.offset.iloc[0]
    axes.plot(ends, strength * ends + offset, color=colour, lw=0.8, label=f"_{label}, Eq. 6.9")
    axes.plot(ends, strength * ends, color=colour, lw=0.7, ls=":", label=f"_{label}, Bowden–Tabor")
    return table.assign(study=label)


def friction_loop(data: xr.Dataset, loaded: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot force and contact of the probe sliding to and fro, at approaches and under loads (beyond the thesis)."""
    tables = []
    for name, study, (force, area), label in (
        ("slide_approach", data, axes[:2], r"$\delta={:g}$ nm"),
        ("slide_mean_pressure", loaded, axes[2:], r"$p={:g}$ GPa"),
    ):
        for value, colour in style.shades(study[name]).items():
            path = study.sel({name: value}).isel(member=0)
            table = slide_table(path)
            force.plot(table.relative_slide, table.force, color=colour, lw=0.9, label=label.format(value))
            area.plot(table.relative_slide, table.area, color=colour, lw=0.9, label=label.format(value))
            for panel, quantity in ((force, "force"), (area, "area")):
                curves.add_arrows(panel, table.relative_slide.to_numpy(), table[quantity].to_numpy(), colour)
            tables.append(table.assign(held=name, value=value, loop_energy=float(path.loop_energy)))
        force.axhline(0.0, **style.ZERO)
        force.set(xlabel=curves.SLIDE, ylabel=curves.FORCE)
        area.set(xlabel=curves.SLIDE, ylabel=curves.AREA)
        style.add_headroom(force, 0.3)
        force.legend(loc="upper left", ncols=2)
    style.add_letters(axes)
    return pd.concat(tables)


def footer(data: xr.Dataset) -> str:
    """Return the law of the curves; nothing is simulated."""
    return law_curves.footer(data)
