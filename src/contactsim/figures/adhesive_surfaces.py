"""Rough adhesive surfaces pressed and pulled off, beside lines with the same spectrum."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.analysis.rough_paths import mean_with_increments
from contactsim.analysis.scales import LawScales
from contactsim.figures import style
from contactsim.grid import Array
from contactsim.observables.path_summary import LEGS, legs
from contactsim.reference.rough_adhesion import sticking_work

AREA = "relative_repulsive_area"
"""What figures show as the contact area: the part under repulsion."""
LINE = ":"
"""Line style of lines, beside surfaces."""
PULLS = {"surfaces": "pull_off_force", "lines": "pull_off_load"}
"""Largest pulls, without the leg of the path."""


def rough_adhesive_surfaces(data: xr.Dataset, lines: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot area against load of pressing and pulling off, and pull-off and dissipated energy against the work."""
    cycle, pull, energy = axes
    tables = [_plot_cycles(cycle, data)]
    units = {"surfaces": _load_unit(data) * float(data.length_y), "lines": _load_unit(lines)}
    ends: dict[str, Any] = {"work_of_separation": data.work_of_separation.values}
    for (name, quantity), paths in zip(PULLS.items(), (data, lines), strict=True):
        line = LINE if name == "lines" else "-"
        for leg, fill in zip(LEGS, ("white", style.CONTACT), strict=True):
            look = style.marker_look(style.CONTACT, fill=fill) | {"ls": line}
            numbers = _plot_against_work(pull, paths, f"{quantity}_{leg}", units[name], f"{name}, {leg}", look)
            ends |= {f"{name}_{key}": values for key, values in numbers.items()}
        look = style.marker_look(style.WHOLE, fill=style.WHOLE) | {"ls": line}
        numbers = _plot_against_work(energy, paths, "dissipated_work", paths.work_of_separation.values, name, look)
        ends |= {f"{name}_{key}": values for key, values in numbers.items()}
    least = _mark_sticking(pull, data)
    pull.set(xscale="log", yscale="log", ylabel=r"largest pull $-p/(E^*\bar g)$")
    energy.set(xscale="log", ylabel=r"dissipated energy / $w$")
    for panel in (pull, energy):
        panel.set_xlabel("work of adhesion $w$ (N/m)")
        panel.set_xticks(data.work_of_separation.values, [f"{work:g}" for work in data.work_of_separation.values])
        panel.tick_params(axis="x", which="minor", bottom=False, top=False, labelbottom=False)
    style.add_log_headroom(pull, 0.8)
    for panel in (pull, energy):
        panel.legend(loc="upper left")
    style.add_letters(axes)
    return pd.concat([*tables, pd.DataFrame(ends).assign(sticking_work=least)])


def _plot_cycles(axes: Axes, data: xr.Dataset) -> pd.DataFrame:
    """Plot the mean area against the mean load, full lines where surfaces are pressed, dashed where pulled off."""
    tables = []
    gradient = float(data.rms_gradient.mean())
    for work, colour in style.shades(data.work_of_separation).items():
        path = data.sel(work_of_separation=work)
        load, area = path.normalised_pressure_mean.values / gradient, path[f"{AREA}_mean"].values
        approach = path.approach.isel(member=0).values
        for leg, states in zip(LEGS, legs(approach), strict=True):
            part, pressing = slice(max(states.start - 1, 0), states.stop), leg == LEGS[0]
            label = rf"$w={work:g}$ N/m" if pressing else rf"_$w={work:g}$ N/m, {leg}"
            axes.plot(load[part], area[part], color=colour, lw=1.0, ls="-" if pressing else "--", label=label)
        some = slice(4, None, 8)
        error = path[f"{AREA}_standard_error"].values[some]
        look = {"color": colour, "fmt": "none", "label": rf"_$w={work:g}$ N/m, error"}
        style.errorbars(axes, load[some], area[some], error, **look)
        table = {"reduced_pressure": load, "area": area, "area_error": path[f"{AREA}_standard_error"].values}
        tables.append(pd.DataFrame(table).assign(work_of_separation=work))
    axes.axvline(0.0, **style.ZERO)
    axes.set(xlabel=r"$p/(E^*\bar g)$", ylabel="relative area under repulsion")
    axes.legend(loc="lower right")
    return pd.concat(tables)


def _load_unit(data: xr.Dataset) -> float:
    """Return the period times E* ḡ, by which a load of a line is a reduced pressure."""
    return float(data.length) * float(data.contact_modulus) * float(data.rms_gradient.mean())


def _plot_against_work(
    axes: Axes, data: xr.Dataset, name: str, unit: float | Array, label: str, look: dict[str, Any]
) -> dict[str, Array]:
    """Plot the mean over members against the work of adhesion; return mean, error and number of members as columns.

    Bars: standard error, increments and grid in quadrature.
    """
    mean, error, members = mean_with_increments(data, name)
    error = np.hypot(error, data.get(f"{name}_grid_error", xr.zeros_like(data.work_of_separation)).values)
    axes.errorbar(data.work_of_separation.values, mean / unit, error / unit, lw=0.8, label=label, **look, **style.BARS)
    return {f"{name}_mean": mean, f"{name}_error": error, f"{name}_members": members}


def _mark_sticking(axes: Axes, data: xr.Dataset) -> float:
    """Mark the work of adhesion from which such surfaces stick by Pastewka and Robbins, and return it."""
    reach = np.e * LawScales.of(data).normal_length  # of the exponential law: its work over its strength
    numbers = [float(data[name].mean()) for name in ("rms_gradient", "rms_curvature")]
    work = sticking_work(reach, float(data.contact_modulus), *numbers)
    axes.axvline(work, color=style.LIGHT_GREY, lw=0.8, ls="--", label="sticking, Pastewka and Robbins")
    return work
