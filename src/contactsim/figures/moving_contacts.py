"""Contacts that grow, jump, peel and slide: the picture of one state beside the measured curves of all.

Each function plots one figure and returns the numbers that it shows. A film calls it for one state after another:
`frame` is the number of a state with fields; without it the state is one that tells most. Limits are the same for all
states.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from contactsim.analysis.asperities import centred_nodes
from contactsim.analysis.ensemble import converged
from contactsim.analysis.scales import LawScales, reduced_line_load
from contactsim.analysis.slide_tables import node_positions, slide_table
from contactsim.figures import style
from contactsim.figures.film import snapshot_steps, states_after_jumps
from contactsim.figures.parts import load_curves, states
from contactsim.figures.parts import slide_curves as curves
from contactsim.observables.path_summary import LEGS

PROBE = 0.06
"""Half of the part of the period that the picture of the probe shows."""


def contact_growth(data: xr.Dataset, axes: list[Axes], *, frame: int | None = None) -> pd.DataFrame:
    """Map the contact of a rough surface at one load, and plot the area against the load."""
    path = data.isel(member=0)
    frame = path.reduced_pressure.size // 2 if frame is None else frame
    pressure, area = path.reduced_pressure.values, path.relative_contact_area.values
    states.plot_contact_map(axes[0], path.isel(reduced_pressure=frame))
    axes[0].set_title(rf"$p^*={pressure[frame]:.2f}$, $a_{{\mathrm{{rel}}}}={area[frame]:.2f}$", fontsize=9)
    axes[1].plot(pressure, area, color=style.CONTACT, lw=1.1, label="_area")
    states.mark_state(axes[1], pressure[frame], area[frame], style.CONTACT)
    axes[1].set(xlabel="reduced pressure $p^*$", ylabel=r"relative contact area $a_{\mathrm{rel}}$")
    axes[1].set(xlim=(0, 1.05 * pressure[-1]), ylim=(0, 1.05 * area.max()))
    axes[1].xaxis.set_major_locator(MaxNLocator(5))
    style.add_letters(axes)
    return pd.DataFrame({"reduced_pressure": pressure, "relative_contact_area": area})


def jump_and_pull_off(data: xr.Dataset, axes: list[Axes], *, frame: int | None = None) -> pd.DataFrame:
    """Plot the surface below a cylinder at one approach, and load against approach in and out."""
    path = data.isel(member=0)
    frame = states_after_jumps(path)[0] if frame is None else frame
    state, step = path.isel(snapshot=frame), snapshot_steps(path)[frame]
    position, nodes = centred_nodes(path)
    states.plot_bodies(axes[0], position / 1e3, state, nodes, float(path.approach[step]))
    axes[0].set(xlabel=r"$x$ (µm)", ylabel="$z$ (nm)", xlim=(-1.5, 1.5), ylim=(-6, 24))
    length, load = LawScales.of(path).normal_length, reduced_line_load(converged(path.line_load, path).values, path)
    tables = [
        load_curves.plot_leg(axes[1], path, leg, color=colour, lw=width, label=leg).assign(leg=leg)
        for leg, colour, width in zip(LEGS, (style.CONTACT, style.WHOLE), (2.2, 0.9), strict=True)
    ]
    axes[0].set_title(rf"$\delta={path.approach.values[step] / length:.2f}\,\delta_n$", fontsize=9)
    states.mark_state(axes[1], path.approach.values[step] / length, float(load[step]), style.EXACT)
    axes[1].axhline(0.0, **style.ZERO)
    axes[1].set(xlabel=r"approach $\delta/\delta_n$", ylabel=load_curves.LOAD_LABEL)
    axes[1].legend(loc="lower right")
    style.add_letters(axes)
    return pd.concat(tables)


def peel_and_slip(data: xr.Dataset, axes: list[Axes], *, frame: int | None = None) -> pd.DataFrame:
    """Plot the gaps under the probe at A to E or at one state, and its force and contact (beyond the thesis)."""
    path = data.isel(member=0)
    gap, force, slip, area = axes
    table, (position, nodes) = slide_table(path), node_positions(path)
    state = path.isel(snapshot=states_after_jumps(path)[0] - 1 if frame is None else frame)
    curves.plot_gap(gap, position, state.normal_gap.values[nodes], 1.0, alpha=0.6)
    slip.plot(position, state.tangential_gap.values[nodes], color=style.PAIRS, lw=1.0, label="_slip")
    states.plot_slide(force, table, "force", float(state.snapshot), style.CONTACT, curves.FORCE)
    states.plot_slide(area, table, "area", float(state.snapshot), style.WHOLE, curves.AREA)
    if frame is None:
        _plot_stages(path, table, axes)
    closed = position[path.normal_gap.isel(snapshot=0).values[nodes] < 0]
    for edge, words in zip(closed[[0, -1]] if closed.size else (), ("trailing", "leading"), strict=False):
        gap.axvline(edge, color=style.LIGHT_GREY, lw=0.8, ls=":", label=f"_{words} edge before sliding")
    gap.axhline(0.0, **style.ZERO)
    gap.set(ylabel="gap (nm)", ylim=(-0.3, 1.2))
    gap.set_title(f"$U_x={float(state.snapshot):.1f}$ nm", fontsize=9)
    gaps = np.array(
        [line.get_ydata() for line in slip.lines] if frame is None else path.tangential_gap.values[:, nodes]
    )
    slip.set(ylabel="tangential gap (nm)", ylim=_range(gaps[:, np.abs(position) < PROBE]))
    for panel in (gap, slip):
        panel.set(xlabel=curves.POSITION, xlim=(-PROBE, PROBE), xticks=np.linspace(-PROBE, PROBE, 5))
    style.add_letters(axes)
    return table


def _plot_stages(path: xr.Dataset, table: pd.DataFrame, axes: list[Axes]) -> None:
    """Plot the gaps of the states A to E, and mark these on the curves."""
    gap, force, slip, area = axes
    position, nodes = node_positions(path)
    places = _stages_with_fields(path, table)
    for name, colour in zip(places, style.shades(range(len(curves.STAGES))).values(), strict=False):
        passed = path.sel(snapshot=float(table.slide[places[name]]), method="nearest")
        look: dict[str, Any] = {"color": colour, "lw": 0.9, "label": f"{name}, {float(passed.snapshot):g} nm"}
        gap.plot(position, passed.normal_gap.values[nodes], **look)
        slip.plot(position, passed.tangential_gap.values[nodes], **look)
    gap.legend(loc="upper center")
    for panel, name, colour in ((force, "force", style.CONTACT), (area, "area", style.WHOLE)):
        curves.mark_stages(panel, table.slide, table[name], places, colour)
        style.add_headroom(panel, 0.06, 0.06)


def _stages_with_fields(path: xr.Dataset, table: pd.DataFrame) -> dict[str, int]:
    """Return the states with fields that are nearest to the stages A to E, by their letters."""
    slides = path.sliding_distance.values[snapshot_steps(path)]
    near = {
        name: slides[np.abs(slides - table.slide[state]).argmin()]
        for name, state in curves.passed_stages(path, table).items()
    }
    return {name: int((table.slide - slide).abs().idxmin()) for name, slide in near.items()}


def rough_slide_forces(data: xr.Dataset, axes: list[Axes], *, frame: int | None = None) -> pd.DataFrame:
    """Plot gap and shear traction of a rough surface at one sliding distance, force and contact of all."""
    path, film = data.isel(member=0), frame is not None
    frame = states_after_jumps(path)[0] - 1 if frame is None else frame
    gap, force, traction, area = axes
    table, state = slide_table(path), path.isel(snapshot=frame)
    x = (path.x / path.length).values
    curves.plot_gap(gap, x, state.normal_gap.values, 0.8)
    gap.set(xlabel="$x/w$", ylabel="gap (nm)", xlim=(0, 1), ylim=_range(path.normal_gap.values))
    gap.set_title(f"$U_x={float(state.snapshot):.1f}$ nm", fontsize=9)
    traction.plot(x, 1e3 * state.tangential_traction.values, color=style.PAIRS, lw=0.8, label="_shear")
    traction.axhline(0.0, **style.ZERO)
    traction.set(xlabel="$x/w$", ylabel="shear traction (MPa)", xlim=(0, 1))
    shown = path if film else state
    traction.set(ylim=_range(1e3 * shown.tangential_traction.values))
    states.plot_slide(force, table, "force", float(state.snapshot), style.CONTACT, curves.FORCE)
    states.plot_slide(area, table, "area", float(state.snapshot), style.WHOLE, curves.AREA)
    style.add_letters(axes)
    return table


def _range(values: np.ndarray) -> tuple[float, float]:
    """Return the limits of an axis that holds the values of all states."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    return low - 0.05 * (high - low), high + 0.05 * (high - low)
