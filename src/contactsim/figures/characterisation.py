"""What the contact of a surface transmits, against the load, with its error."""

from __future__ import annotations

from typing import Annotated

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactsim.arguments import Only, checked
from contactsim.figures import style
from contactsim.figures.parts.scale_bar import fitting_unit
from contactsim.reference.persson import persson_area
from contactsim.status import is_solved

PERSSON = r"Persson, erf$(\sqrt{2}p^*)$"

Characterised = Annotated[
    xr.Dataset, Only("a dataset that characterise returned", lambda data: "mean_gap_grid_error" in data)
]


@checked
def plot_characterisation(data: Characterised, *, title: str = "", size: tuple[float, float] = (6.9, 5.2)) -> Figure:
    """Return a figure of the area, the stiffness, the mean gap and the largest pressure of a contact.

    Parameters
    ----------
    data : xarray.Dataset
        Result of `contactsim.characterise`.
    title : str
        What was pressed, for the line above the panels, which also has the contact modulus.
    size : (float, float)
        Width and height, inches.

    Returns
    -------
    matplotlib.figure.Figure
        Four panels against the mean pressure; bars are changes on halving the grid.
    """
    solved = data.isel(mean_pressure=np.flatnonzero(is_solved(data.status)))
    factor, unit = fitting_unit(float(solved.mean_gap.max()) if solved.mean_gap.size else 1.0, "nm")
    with mpl.rc_context(style.RC_PARAMS):
        figure = Figure(figsize=size, dpi=style.RC_PARAMS["savefig.dpi"], layout="constrained")
        (area, stiffness), (gap, pressure) = figure.subplots(2, 2)
        _draw(area, solved, "relative_contact_area_subgrid", "relative contact area")
        if "length_y" in solved:  # Persson's theory is of surfaces
            loads = np.geomspace(solved.mean_pressure.min(), solved.mean_pressure.max(), 100)
            reduced = loads / float(solved.contact_modulus * solved.rms_gradient)
            area.plot(loads, persson_area(reduced), lw=1, **{"ls": "-.", "color": style.EXACT, "label": PERSSON})
            area.legend(loc="upper left")
        _draw(stiffness, solved, "contact_stiffness", r"stiffness $\mathrm{d}p/\mathrm{d}\delta$ (GPa/nm)")
        _draw(gap, solved, "mean_gap", f"mean gap ({unit})", factor)
        _draw(pressure, solved, "max_pressure", "largest pressure (GPa)")
        for axes in (gap, pressure):
            axes.set_yscale("linear")
            axes.set_ylim(0)
        style.add_letters(figure.axes)
        modulus = f"$E^*$ = {float(data.contact_modulus):g} GPa"
        words = title.replace("$", r"\$")  # a name of a file is no formula
        figure.suptitle(f"{words}, {modulus}" if words else modulus, fontsize="medium")
    return figure


def _draw(axes: Axes, data: xr.Dataset, name: str, label: str, factor: float = 1.0) -> None:
    """Draw a number against the mean pressure, with its error, on logarithmic axes."""
    bars = data[f"{name}_grid_error"] * factor
    style.errorbars(axes, data.mean_pressure, data[name] * factor, bars, **style.marker_look(style.CONTACT), lw=1)
    is_positive = bool((np.isfinite(data[name]) & (data[name] > 0)).any())  # complete contact has no gap to draw
    axes.set(xscale="log", yscale="log" if is_positive else "linear", xlabel=r"mean pressure $p$ (GPa)", ylabel=label)
