"""Parts of the figures of flats that slide: force curves, periods, mean friction and the range of smooth sliding."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.analysis import slide_tables
from contactsim.analysis.scales import LawScales, lattice_constant
from contactsim.analysis.slide_tables import slide_table
from contactsim.figures import style
from contactsim.reference import springs

BAND_TOP = 0.74
"""Upper end of the shaded range, as a part of the panel: the legend is above it."""


def prandtl_tomlinson_label(data: xr.Dataset) -> str:
    """Return the label of the model of Prandtl and Tomlinson, with the distance of the springs' sum to its sine."""
    lattice, length = lattice_constant(data), LawScales.of(data).tangential_length
    places = np.linspace(0.0, lattice, 1001)
    sums, sine = springs.spring_sum(places, lattice, length)[1], springs.sine_sum(places, lattice, length)
    distance = 100 * np.abs(sums - sine).max() / sums.max()
    return f"Prandtl–Tomlinson: a sine as high\n(differs from the springs' sum by {distance:.1g} %)"


def mark_periods(axes: Axes, lattice: float, end: float) -> None:
    """Mark the multiples of the lattice constant on the upper edge of a panel of slides, nm."""
    for place in np.arange(lattice, end, lattice):
        axes.axvline(place, ymin=0.97, color=style.LIGHT_GREY, lw=0.6, label=f"_period {round(place / lattice)}")


def plot_flat(axes: Axes, data: xr.Dataset, colour: str) -> pd.DataFrame:
    """Plot the force of one flat and the exact answer."""
    path = data.isel(member=0)
    modulus = float(path.counter_body_youngs_modulus)
    work = float(path.work_ratio) * LawScales.of(data).work_of_separation
    table = slide_table(path)
    table = table.assign(exact=slide_tables.exact_flat_force(path, table.slide.values))
    label = rf"$\bar E={modulus:g}$, $\bar\varphi_t={work:g}$"
    axes.plot(table.slide, table.force, color=colour, lw=1.1, label=label)
    exact: dict[str, Any] = {"color": style.EXACT, "ms": 1.6, "zorder": 3, "label": f"_{label}, exact"}
    axes.plot(table.slide[::4], table.exact[::4], ".", **exact)
    sine = slide_tables.exact_flat_force(path, table.slide.values, sine=True)
    axes.plot(table.slide, sine, color=colour, lw=0.7, ls=":", label=f"_{label}, Prandtl–Tomlinson")
    return table.assign(sine=sine, youngs_modulus=modulus, tangential_work=work)


def plot_friction(axes: Axes, table: pd.DataFrame, colour: str, label: str) -> None:
    """Plot both means of the friction of flats against modulus over strength, with their increment errors."""
    for name, fill, line in (("mean_friction", colour, "-"), ("average_friction", "white", "--")):
        own_label = label if name == "mean_friction" else f"_{label}, mean over whole periods"
        look = style.marker_look(colour, size=3.5, fill=fill) | {"ls": line, "lw": 0.9, "label": own_label}
        axes.errorbar(table.modulus_over_strength, table[name], table[f"{name}_increment_error"], **look, **style.BARS)


def shade_smooth(axes: Axes, critical: float, end: float, thickness: float, colour: str) -> None:
    """Shade the range in which flats slide without stick-slip, to the end of the axis."""
    axes.axvspan(critical, end, ymax=BAND_TOP, color=colour, alpha=0.12, lw=0)
    axes.axvline(critical, ymax=BAND_TOP, color=colour, lw=0.8, ls=":", label=f"_smooth at $h={thickness:g}$ nm")
    look: dict[str, Any] = {"transform": axes.get_xaxis_transform(), "fontsize": 7, "va": "top", "color": colour}
    axes.text(1.04 * critical, 0.3, f"smooth at\n$h={thickness:g}$ nm", **look)
