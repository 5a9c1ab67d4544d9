"""Curves of smooth adhesive asperities: traction across the contact, contact size, load by two laws, pull-off."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.analysis.asperities import centred_nodes, contact_sizes, pull_off_table
from contactsim.analysis.scales import radius, reduced_line_load
from contactsim.figures import style
from contactsim.figures.parts.load_curves import plot_leg
from contactsim.observables.path_summary import LEGS

LARGEST_APPROACH = 10.0
"""Approach (nm) at which fields of the indented asperity are kept."""
WORK_RATIO_LINES = {0.0: "--", 0.1: "-.", 0.5: ":", 1.0: "-"}
"""Lines of ratios of works φt/φn."""
NEGLIGIBLE_TRACTION = 0.01
"""Part of the strength below which a traction is not shown."""
COUPLING_LINES = {"coupled": "-", "uncoupled": "--"}


def work_ratio_line(ratio: float) -> Any:
    """Return the line of a ratio of works."""
    return WORK_RATIO_LINES.get(round(float(ratio), 6), (0, (1, 3)))


def work_ratio_label(ratio: float) -> str:
    """Return the label of a ratio of works."""
    return rf"$\varphi_t/\varphi_n={float(ratio):g}$"


def at_approach(data: xr.Dataset, approach: float) -> xr.Dataset:
    """Return the fields of the first member at an approach, nm."""
    return data.isel(member=0).sel(snapshot=approach, method="nearest", tolerance=style.PLACE_TOLERANCE)


def plot_profiles(axes: Axes, parts: list[xr.Dataset], work: float) -> pd.DataFrame:
    """Plot the normal traction over the strength across the contact, one curve a ratio of works.

    work: of separation, N/m
    """
    profiles = [_plot_profile(axes, data) for data in parts]
    size, width = radius(parts[0]), max(profile[1] for profile in profiles)
    axes.axhline(0.0, **style.ZERO)
    axes.set(xlim=(-1.1 * width / size, 1.1 * width / size), xlabel=r"$x/R$")
    axes.set_ylabel(r"$T_n/\sigma_{\max}$ (pull positive)")
    style.add_headroom(axes, 0.28)
    axes.legend(loc="upper center")
    table = pd.concat([profile[0] for profile in profiles])
    return table[np.abs(table.position) <= 1.1 * width].assign(strength=work / np.e)


def _plot_profile(axes: Axes, data: xr.Dataset) -> tuple[pd.DataFrame, float]:
    """Plot one profile; return it, and how far from the middle (nm) its traction is not negligible."""
    size, ratio = radius(data), float(data.work_ratio)
    position, nodes = centred_nodes(data)
    strength = float(data.strength.isel(member=0) if "member" in data.strength.dims else data.strength)
    traction = at_approach(data, LARGEST_APPROACH).normal_traction.values[nodes] / strength
    contact = float(data.final_contact_length.isel(member=0))
    label = rf"{work_ratio_label(ratio)}, $l_{{\mathrm{{rep}}}}/R$ = {contact / size:.4f}"
    colour = style.variable_colours("work_ratio", ratio)[ratio]
    axes.plot(position / size, traction, color=colour, ls=work_ratio_line(ratio), lw=1.1, label=label)
    table = pd.DataFrame({"position": position, "normal_traction": traction * strength})
    width = float(np.abs(position[np.abs(traction) > NEGLIGIBLE_TRACTION]).max())
    return table.assign(work_ratio=ratio, contact_length=contact), width


def plot_sizes(axes: Axes, data: xr.Dataset, label: str, change: Axes | None, **look: Any) -> pd.DataFrame:
    """Plot the contact size against the ratio of works, and on another axes its change from no friction in per cent."""
    sizes = contact_sizes(data)
    curve = {"marker": "o", "ms": 3, "mfc": "white", "lw": 1.0} | look
    axes.errorbar(sizes.work_ratio, sizes.size_ratio, sizes.error, label=label, elinewidth=0.8, **curve)
    if change is not None:
        relative = 100 * (sizes.size_ratio / sizes.size_ratio.iloc[0] - 1)
        change.plot(sizes.work_ratio, relative, label=label, **curve)
    return sizes


def plot_both_laws(
    axes: list[Axes], coupled: xr.Dataset, uncoupled: xr.Dataset, colour: str, label: str, **place: object
) -> pd.DataFrame:
    """Plot loading and unloading, one panel each, by the coupled and the uncoupled law.

    label: of the case; place: columns of the table
    """
    tables = []
    for (law, line), data in zip(COUPLING_LINES.items(), (coupled, uncoupled), strict=True):
        for leg, leg_axes in zip(LEGS, axes, strict=True):
            look = {"color": colour, "ls": line, "lw": 1.0, "label": f"_{label}, {law}"}
            curve = plot_leg(leg_axes, data.isel(member=0), leg, **look)
            tables.append(curve.assign(law=law, leg=leg, **place))
    return pd.concat(tables)


def plot_pull_off(axes: Axes, data: xr.Dataset, colour: str, label: str) -> pd.DataFrame:
    """Plot the pull-off on loading and on unloading against the work of separation, with grid errors as bars."""
    table = pull_off_table(data, LEGS)
    for leg, fill in zip(LEGS, (colour, "white"), strict=True):
        load, error = (table[f"pull_off_load_{leg}{suffix}"] for suffix in ("", "_grid_error"))
        bars = None if error.isna().all() else reduced_line_load(error, data)
        look = style.marker_look(colour, fill=fill) | {"lw": 0.7 if fill == colour else 0.0, "elinewidth": 0.8}
        look |= {"label": f"_{label}, {leg}"}
        axes.errorbar(table.work_of_separation, reduced_line_load(load, data), bars, **look)
    return table
