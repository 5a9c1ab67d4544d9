"""Chapter 4: smooth adhesive asperities. Each function plots one figure and returns the numbers that it shows.

Keyword arguments are values of the thesis, from `reference` in the config. Loads are per length along the cylinder; as
in the thesis they are divided by πRφ0 with φ0 = 1 N/m, which leaves a number only for a length of 1 µm.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim.analysis.asperities import centred_nodes, local_slopes, pull_off_limits
from contactsim.analysis.scales import reduced_line_load
from contactsim.analysis.stress import stress_below_contact
from contactsim.figures import style
from contactsim.figures.parts import asperities, load_curves, stress
from contactsim.observables.path_summary import LEGS

APPROACH_BEFORE_CONTACT = -5.0
"""Approach (nm) before the contact closes at which fields are kept."""
WORK = 2.0
"""Work of separation, N/m, of the figures for which the thesis names one."""
POISSON_RATIO = 0.3
"""Poisson's ratio of the figures for which the thesis names one."""


def fig_4_2(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the normal traction at the largest approach, with and without friction (thesis Fig. 4.2)."""
    tables = []
    for panel, work in zip(axes, (WORK, 0.8), strict=True):
        parts = [data.sel(work_of_separation=work, work_ratio=ratio) for ratio in (0.0, 1.0)]
        tables.append(asperities.plot_profiles(panel, parts, work).assign(work_of_separation=work))
        panel.set_title(rf"$\varphi_n={work:g}$ N/m", fontsize=9)
    style.add_letters(axes)
    return pd.concat(tables)


def fig_4_3(soft: xr.Dataset, close: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the same for a nearly incompressible layer, and for asperities close to each other (thesis Fig. 4.3)."""
    cases = {r"$\nu=0.45$, $w/R=0.4$": soft, r"$\nu=0.3$, $w/R=0.08$": close}
    tables = []
    for panel, (case, data) in zip(axes, cases.items(), strict=True):
        parts = [data.sel(work_ratio=ratio) for ratio in (0.0, 1.0)]
        tables.append(asperities.plot_profiles(panel, parts, WORK).assign(case=case.replace("$", "")))
        panel.set_title(case, fontsize=9)
    style.add_letters(axes)
    return pd.concat(tables)


def fig_4_4(data: xr.Dataset, soft: xr.Dataset, close: xr.Dataset, thick: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the contact size against the ratio of works, for several works and bodies (thesis Fig. 4.4)."""
    works, bodies, change = axes
    tables = []
    colours = style.variable_colours("work_of_separation", data.work_of_separation)
    for work in data.work_of_separation.values.tolist():
        look = {"color": colours[work], "ls": "-"}
        label, body = rf"$\varphi_n={work:g}$ N/m", data.sel(work_of_separation=work)
        tables.append(_plot_case(works, body, label, change, **look))
    reference = data.sel(work_of_separation=WORK)
    tables.append(_plot_case(bodies, reference, "reference", None, color=colours[WORK], ls="-"))
    for label, body, colour, line in (
        (r"$\nu=0.45$", soft, style.WHOLE, "--"),
        (r"$w/R=0.08$", close, style.PAIRS, ":"),
        (r"$h/R=0.8$", thick, style.EXACT, "-."),
    ):
        tables.append(_plot_case(bodies, body, label, change, color=colour, ls=line))
    works.set(ylabel=r"contact size $l_{\mathrm{rep}}/R$")
    bodies.set(ylabel=r"$l_{\mathrm{rep}}/R$")
    change.set(ylabel=r"change from $\varphi_t=0$ (%)")
    change.axhline(0.0, **style.ZERO)
    for panel in axes:
        panel.set(xlabel=r"$c=\varphi_t/\varphi_n$")
    for panel in (works, bodies):
        style.add_headroom(panel, 0.3)
        panel.legend(loc="upper left", ncols=2)
    style.add_letters(axes)
    return pd.concat(tables)


def _colours(data: xr.Dataset, variable: str) -> dict[float, str]:
    """Return the colours of the values of a variable of a dataset."""
    values = data[variable].values.tolist()
    return {value: style.variable_colours(variable, values)[value] for value in values}


def _plot_case(axes: Axes, data: xr.Dataset, label: str, change: Axes | None, **look: Any) -> pd.DataFrame:
    """Plot the contact sizes of one case."""
    table = asperities.plot_sizes(axes, data, label, change, **look)
    return table.assign(case=label.replace("$", ""))


def fig_4_5(data: xr.Dataset, uncoupled: xr.Dataset, pulled: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot load against approach by the coupled and the uncoupled law without friction (thesis Fig. 4.5)."""
    frictionless = data.sel(work_ratio=0.0)
    tables = []
    works = _colours(uncoupled, "work_of_separation")
    for work, colour in works.items():
        coupled = frictionless.sel(work_of_separation=work)
        other = uncoupled.sel(work_of_separation=work, poisson_ratio=POISSON_RATIO)
        place = {"work_of_separation": work, "poisson_ratio": POISSON_RATIO}
        label = rf"$\varphi_n={work:g}$ N/m"
        tables.append(asperities.plot_both_laws(axes[::2], coupled, other, colour, label, **place))
    ratios = _colours(uncoupled, "poisson_ratio")
    for ratio, colour in ratios.items():
        at_ratio = pulled.sel(work_ratio=0.0) if ratio in pulled.poisson_ratio else None
        coupled = frictionless if at_ratio is None else at_ratio.sel(poisson_ratio=ratio)
        other = uncoupled.sel(work_of_separation=WORK, poisson_ratio=ratio)
        place = {"work_of_separation": WORK, "poisson_ratio": ratio}
        coupled = coupled.sel(work_of_separation=WORK)
        tables.append(asperities.plot_both_laws(axes[1::2], coupled, other, colour, rf"$\nu={ratio:g}$", **place))
    lines = style.line_handles(asperities.COUPLING_LINES)
    of_works = {rf"$\varphi_n={work:g}$ N/m": colour for work, colour in works.items()}
    of_ratios = {rf"$\nu={ratio:g}$": colour for ratio, colour in ratios.items()}
    for panel, labels in zip(axes, (of_works, of_ratios) * len(LEGS), strict=True):
        panel.legend(handles=style.colour_handles(labels) + lines, loc="upper left")
    style.share_vertical_range(axes)
    fixed = rf"$\nu={POISSON_RATIO:g}$", rf"$\varphi_n={WORK:g}$ N/m"
    load_curves.label_panels(axes, tuple(f"{leg}, {value}" for leg in LEGS for value in fixed))
    return pd.concat(tables)


def fig_4_6(pulled: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the deformed surface before the contact closes, for two Poisson's ratios (thesis Fig. 4.6)."""
    tables = []
    for ratio, colour in _colours(pulled, "poisson_ratio").items():
        data = pulled.sel(poisson_ratio=ratio, work_of_separation=WORK, work_ratio=0.0)
        position, nodes = centred_nodes(data)
        displacement = asperities.at_approach(data, APPROACH_BEFORE_CONTACT).normal_displacement.values[nodes]
        for panel in axes:
            panel.plot(position / 1e3, displacement, color=colour, lw=1.1, label=rf"$\nu={ratio:g}$")
        profile = pd.DataFrame({"position": position, "normal_displacement": displacement})
        tables.append(profile.assign(poisson_ratio=ratio))
    table = pd.concat(tables)
    outside = table[np.abs(table.position) > 0.1 * np.ptp(table.position)].normal_displacement
    margin = 0.15 * np.ptp(outside)
    axes[1].set_ylim(outside.min() - margin, outside.max() + margin)
    for panel in axes:
        panel.axhline(0.0, **style.ZERO)
        panel.set(xlabel=r"$x$ (µm)", ylabel=r"displacement $u_z$ (nm)")
    axes[0].legend(loc="upper right")
    style.add_letters(axes)
    return table


def fig_4_7(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot load against approach for three ratios of works (thesis Fig. 4.7)."""
    tables = []
    colours = _colours(data, "work_ratio")
    for ratio in (0.0, 0.1, 1.0):
        colour = colours[ratio]
        path = data.sel(work_of_separation=WORK, work_ratio=ratio).isel(member=0)
        for leg, panel in zip(LEGS, axes, strict=True):
            load, approach = (float(path[f"pull_off_{name}_{leg}"]) for name in ("load", "approach"))
            label = f"{asperities.work_ratio_label(ratio)}: pull-off {load:.1f} N/m at {approach:.2f} nm"
            look = {"color": colour, "ls": asperities.work_ratio_line(ratio), "lw": 1.1, "label": label}
            tables.append(load_curves.plot_leg(panel, path, leg, **look).assign(work_ratio=ratio, leg=leg))
    for panel in axes:
        panel.legend(loc="upper left")
    load_curves.label_panels(axes, LEGS)
    return pd.concat(tables)


def fig_4_8(pulled: xr.Dataset, axes: list[Axes], *, slope: float) -> pd.DataFrame:
    """Plot the pull-off against the work for two Poisson's ratios and three ratios of works (thesis Fig. 4.8).

    slope: the thesis's exponent.
    """
    tables = []
    colours = _colours(pulled, "work_ratio")
    *loads, slopes = axes
    for panel, ratio in zip(loads, (0.45, 0.1), strict=True):
        body = pulled.sel(poisson_ratio=ratio).isel(member=0)
        for work_ratio, colour in colours.items():
            label = asperities.work_ratio_label(work_ratio)
            curve = asperities.plot_pull_off(panel, body.sel(work_ratio=work_ratio), colour, label)
            tables.append(curve.assign(poisson_ratio=ratio, work_ratio=work_ratio))
        lines = _plot_pull_off_limits(panel, body, ratio, slope)
        tables.append(_plot_local_slopes(slopes, body, ratio))
        panel.set(xscale="log", yscale="log", xlabel=r"work of separation $\varphi_n/\varphi_0$")
        for axis, limits in ((panel.xaxis, panel.get_xlim()), (panel.yaxis, panel.get_ylim())):
            style.set_log_ticks(axis, *limits)
        panel.set_ylabel(load_curves.LOAD_LABEL.replace(r"$\bar L", r"pull-off $-\bar L", 1))
        panel.set_title(rf"$\nu={ratio:g}$", fontsize=9)
    legs = [
        Line2D([], [], ls="none", label=leg, **style.marker_look(style.GREY, fill=fill))
        for leg, fill in zip(LEGS, (style.GREY, "white"), strict=True)
    ]
    labels = {asperities.work_ratio_label(ratio): colour for ratio, colour in colours.items()}
    handles = style.colour_handles(labels) + style.line_handles(lines) + legs
    axes[0].legend(handles=handles, loc="upper left")
    for exponent, line, label in ((slope, ":", f"_exponent of the thesis, {slope:.3g}"), (1.0, style.THESIS, "_rigid")):
        slopes.axhline(exponent, color=style.EXACT, lw=0.8, ls=line, label=label)
    slopes.set(xscale="log", xlabel=r"work of separation $\varphi_n/\varphi_0$")
    slopes.set_ylabel(r"local slope $\mathrm{d}\ln|\bar L|/\mathrm{d}\ln\varphi_n$")
    style.set_log_ticks(slopes.xaxis, *slopes.get_xlim())
    slopes.legend(loc="lower left")
    style.add_letters(axes)
    return pd.concat(tables)


def _plot_local_slopes(axes: Axes, body: xr.Dataset, poisson_ratio: float) -> pd.DataFrame:
    """Plot the local slopes of the frictionless pull-off on loading, and of the model of Maugis and Dugdale."""
    colour = style.variable_colours("poisson_ratio", poisson_ratio)[poisson_ratio]
    work = body.work_of_separation.values
    middle, slope = local_slopes(work, body.pull_off_load_loading.sel(work_ratio=0.0).values)
    label = rf"$\nu={poisson_ratio:g}$, $\varphi_t=0$"
    axes.plot(middle, slope, lw=0.8, label=label, color=colour, marker="o", ms=4)
    fine = np.geomspace(work[0], work[-1], 50)
    exact = local_slopes(fine, pull_off_limits(body, poisson_ratio, fine)["Maugis"])
    axes.plot(*exact, color=colour, lw=0.8, ls="-.", label=rf"Maugis–Dugdale, $\nu={poisson_ratio:g}$")
    table = pd.DataFrame({"work_of_separation": middle, "local_slope": slope})
    return table.assign(poisson_ratio=poisson_ratio, work_ratio=0.0)


def _plot_pull_off_limits(axes: Axes, body: xr.Dataset, poisson_ratio: float, slope: float) -> dict[str, Any]:
    """Plot the power law of the thesis and the limits of an elastic half-space and of rigid bodies.

    Returns their line styles by label.
    """
    works = body.work_of_separation.values
    work = np.geomspace(works[0], works[-1], 50)
    first = body.pull_off_load_loading.isel(work_of_separation=0).sel(work_ratio=0.0)
    limits = pull_off_limits(body, poisson_ratio, work)
    exponent = "2/3" if np.isclose(slope, 2 / 3, atol=1e-3) else f"{slope:g}"
    curves = {
        rf"$\bar\varphi_n^{{{exponent}}}$": (float(reduced_line_load(first, body)) * (work / works[0]) ** slope, ":"),
        "JKR, half-space": (limits["JKR"], "-"),
        "Maugis–Dugdale": (limits["Maugis"], "-."),
        "rigid": (limits["rigid"], style.THESIS),
    }
    for label, (load, line) in curves.items():
        axes.plot(work, load, color=style.EXACT, lw=0.8, ls=line, label=label)
    return {label: line for label, (_, line) in curves.items()}


def stress_field(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Map the stress in the layer under the contact at the largest approach, with friction (Section 2.2)."""
    path = data.sel(work_of_separation=WORK, work_ratio=1.0)
    state = asperities.at_approach(path, asperities.LARGEST_APPROACH)
    edge = float(state.final_contact_length) / 2
    for panel in axes:
        edges: dict[str, Any] = {"color": style.EXACT, "ms": 4, "ls": "none", "clip_on": False}
        edges["label"] = "edges of the contact"
        panel.plot([-edge, edge], [0.0, 0.0], "v", **edges)
    return stress.plot_stress(stress_below_contact(state), axes)
