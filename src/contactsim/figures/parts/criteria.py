"""Curves of the contact area by several criteria of contact, and where the law does not describe the overlap."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.analysis.rough_paths import member_mean, relative_areas, states_of_all_members
from contactsim.figures import style
from contactsim.figures.parts.rough_curves import AREA, BAR_SPACING, LABELS
from contactsim.observables.adhesion import CRITERION, INTERACTING
from contactsim.status import FLAGS, LIMITS


def plot_criteria(axes: Axes, data: xr.Dataset, ratio_axes: Axes | None) -> pd.DataFrame:
    """Plot the mean area by every criterion, and on other axes over the area by the usual one.

    Means end where the path of the first member does.
    """
    data = data.isel(step=states_of_all_members(data))
    areas = relative_areas(data, ["contact_length", *INTERACTING])
    usual, _ = member_mean(areas[CRITERION])
    tables = []
    for place, ((name, area), colour) in enumerate(
        zip(areas.items(), style.shades(range(len(areas))).values(), strict=True)
    ):
        mean, error = member_mean(area)
        label = criterion_label(name)
        axes.plot(data.indentation, mean, color=colour, lw=1.0, label=label)
        some = slice(place - len(areas), None, -BAR_SPACING)
        look = style.BARS | {"color": colour, "ls": "none", "label": f"_{label}, errors"}
        axes.errorbar(data.indentation[some], mean[some], error[some], **look)
        if ratio_axes is not None:
            ratio_axes.plot(data.indentation, mean / usual, color=colour, lw=1.0, label=label)
        table = {"indentation": data.indentation, "area": mean, "standard_error": error}
        tables.append(pd.DataFrame(table).assign(criterion=name))
    axes.set(xlabel=LABELS["indentation"], ylabel=LABELS[AREA], ylim=(0, 1))
    return pd.concat(tables)


def criterion_label(name: str) -> str:
    """Return the label of a criterion of contact, by the name of its length."""
    if name not in INTERACTING:
        return "repulsive"
    return rf"above $10^{{{round(np.log10(INTERACTING[name]))}}}$ of the strength"


def shade_overlap(axes: Axes, data: xr.Dataset) -> None:
    """Shade the approaches at which bodies overlap by more than the law describes, in any member.

    data: of one variant, of `contactsim.analysis.rough_paths.with_indentation`
    """
    flags = data.validity_flags.fillna(0).astype(int) & FLAGS["max_interpenetration"]
    beyond = data.indentation.values[(flags > 0).any("member").values]
    if beyond.size:
        axes.axvspan(beyond.min(), axes.get_xlim()[1], color=style.LIGHT_GREY, alpha=0.2, lw=0)
        axes.margins(x=0)
        words = rf" overlap above {LIMITS['max_interpenetration'][0]:g} $\delta_n$"
        axes.text(beyond.min(), 0.98, words, transform=axes.get_xaxis_transform(), fontsize=7, va="top")
