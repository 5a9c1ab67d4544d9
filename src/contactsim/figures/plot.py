"""Draw one simulation: contact area against pressure, load against approach, or the pressure of one load."""

from __future__ import annotations

import xarray as xr
from matplotlib.axes import Axes

from contactsim.arguments import checked
from contactsim.errors import InputError, Words
from contactsim.grid import Grid
from contactsim.solvers.base import Result, pressed_scene

QUANTITIES = {
    "hard_wall": (("mean_pressure", "relative_contact_area"),),
    "cohesive": (("approach", "line_load"), ("approach", "normal_force")),
}
"""Quantities across and up, by the problem that a dataset solves; the first pair that it has is drawn."""


@checked
def plot(
    data: xr.Dataset | Result, axes: Axes | None = None, *, across: str | None = None, up: str | None = None
) -> Axes:
    """Draw a quantity of a simulation against another, or the pressure of one load at each place.

    Parameters
    ----------
    data : xarray.Dataset or Result
        Result of `contactsim.simulate` or of `contactsim.press`, or a dataset of the workflow.
    axes : matplotlib.axes.Axes, optional
        Where to draw; new axes by default.
    across, up : str, optional
        Variables of a dataset to draw; by default pressure and contact area at a hard wall, approach and load along a
        path.

    Returns
    -------
    matplotlib.axes.Axes
        With a line for each member and variant, and labels with units; of one load in the units that it was pressed in.
    """
    if isinstance(data, Result):
        if across is not None or up is not None:
            raise InputError("up" if across is None else "across", across or up, "none with a result of `press`")
        return _draw_pressure(data, axes or _new_axes())
    if data.attrs.get("problem") not in QUANTITIES:
        allowed = "a result of `simulate` or of the workflow; `plot_characterisation` draws one of `characterise`"
        raise InputError("data", Words("another dataset"), allowed)
    pairs = QUANTITIES[data.attrs["problem"]]
    default_across, default_up = next((pair for pair in pairs if set(pair) <= set(data.variables)), pairs[0])
    names = across or default_across, up or default_up
    for name in names:
        if name not in data.variables:
            raise InputError("plot", name, f"a variable of the dataset: {', '.join(sorted(map(str, data.variables)))}")
    axes = axes or _new_axes()
    x, y = xr.broadcast(data[names[0]], data[names[1]])
    steps = data[names[0]].dims[-1] if data[names[0]].ndim == 1 else data.status.dims[-1]
    rest = [dim for dim in x.dims if dim != steps]
    stacked = [values.stack(line=rest).transpose(steps, "line") if rest else values for values in (x, y)]
    axes.plot(*(values.values for values in stacked), ".-")
    axes.set_xlabel(_label(data[names[0]]))
    axes.set_ylabel(_label(data[names[1]]))
    return axes


def _new_axes() -> Axes:
    """Return axes in a figure of their own."""
    import matplotlib.pyplot as plt  # sets up a window system, which importing this package must not

    return plt.figure(layout="constrained").subplots()


def _draw_pressure(result: Result, axes: Axes) -> Axes:
    """Draw the pressure along a line, or over a surface."""
    scene = pressed_scene(result)
    if result.pressure.ndim == 1:
        axes.plot(Grid(result.pressure.shape, scene.lengths).positions(), result.pressure)
        axes.set(xlabel="x", ylabel="pressure")
        return axes
    width, length = scene.lengths
    image = axes.imshow(result.pressure, origin="lower", extent=(0.0, length, 0.0, width), cmap="magma_r")
    axes.figure.colorbar(image, ax=axes, label="pressure")
    axes.set(xlabel="x", ylabel="y")
    return axes


def _label(values: xr.DataArray) -> str:
    """Return the long name of a variable with its unit."""
    name, unit = values.attrs.get("long_name", values.name), values.attrs.get("units", "1")
    return name if unit == "1" else f"{name} ({unit})"
