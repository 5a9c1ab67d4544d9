"""Rough adhesive lines beyond Chapter 5: cycles, criteria of contact, and bodies of finite height.

Each function plots one figure and returns the numbers that it shows.
"""

from __future__ import annotations

import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.analysis.body_heights import compare_heights, heights_to_compare
from contactsim.analysis.contact_criteria import compare_criteria
from contactsim.analysis.rough_paths import with_indentation
from contactsim.analysis.scales import LawScales
from contactsim.figures import style
from contactsim.figures.parts import body_heights as bodies
from contactsim.figures.parts import criteria, cycles
from contactsim.figures.parts import rough_curves as rough
from contactsim.observables.path_summary import LEGS


def body_heights(data: xr.Dataset, wall: xr.Dataset, repulsive: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Plot the largest difference between load curves against the body's height, last of all on a half-space."""
    table = compare_heights((data, wall, repulsive), heights_to_compare(data))
    table = pd.concat([table.iloc[1:], table.iloc[:1]], ignore_index=True)
    bodies.plot_differences(axes, table)
    return table


def unloading(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot cycles of approach and retraction for rms heights, pull-off and dissipated energy (beyond the thesis)."""
    panels = {"normalised_pressure": axes[0], rough.AREA: axes[1]}
    tables = []
    colours = style.variable_colours("surface_rms_height", data.surface_rms_height)
    for height in data.surface_rms_height.values.tolist():
        path = data.sel(surface_rms_height=height).isel(member=0)
        cycle = cycles.plot_cycle(path, rf"$h_{{\mathrm{{rms}}}}={height:g}$ nm", colours[height], panels)
        cycle.insert(0, "rms_height", height)
        tables.append(cycle)
    axes[0].axhline(0.0, **style.ZERO)
    axes[1].legend(loc="upper left")
    ends = {"rms_height": data.surface_rms_height.values}
    full_load, work = float(data.length) * float(data.contact_modulus), LawScales.of(data).work_of_separation
    for leg, fill in zip(LEGS, (style.CONTACT, "white"), strict=True):
        look = leg, style.CONTACT, fill
        ends |= cycles.plot_against_height(axes[2], data, f"pull_off_load_{leg}", full_load, *look)
    axes[2].set(yscale="log", ylabel=r"pull-off $-p/E^*$")
    axes[2].legend(loc="upper right")
    ends |= cycles.plot_against_height(axes[3], data, "dissipated_work", work, "per cycle", style.WHOLE, style.WHOLE)
    axes[3].set_ylabel(r"dissipated energy / $\varphi_n$")
    for panel in axes[2:]:
        panel.set(xlabel=r"$h_{\mathrm{rms}}$ (nm)")
    style.add_letters(axes)
    return pd.concat([*tables, pd.DataFrame(ends)])


def thresholds(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot the relative area by every criterion, for the strongest and the weakest adhesion (beyond the thesis).

    The table ends with what statements are about, by every criterion.
    """
    strongest, weakest = float(data.work_of_separation.max()), float(data.work_of_separation.min())
    tables = []
    for panel, work, ratio_panel in ((axes[0], strongest, axes[2]), (axes[1], weakest, None)):
        variant = with_indentation(data.sel(work_of_separation=work))
        tables.append(criteria.plot_criteria(panel, variant, ratio_panel).assign(work_of_separation=work))
        criteria.shade_overlap(panel, variant)
        panel.set_title(rough.work_label(data, work), fontsize=9)
    axes[2].set(xlabel=rough.LABELS["indentation"], ylabel="area over that above $10^{-2}$", yscale="log")
    style.add_log_headroom(axes[2], 0.5)
    axes[2].legend(loc="upper right")
    style.add_letters(axes)
    return pd.concat([*tables, compare_criteria(data.sel(work_of_separation=[weakest, strongest]))])
