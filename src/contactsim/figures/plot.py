"""Draw one simulation: contact area against pressure, or load against approach."""

from __future__ import annotations

import xarray as xr
from matplotlib.axes import Axes

from contactsim.errors import InputError, Words

QUANTITIES = {
    "hard_wall": (("mean_pressure", "relative_contact_area"),),
    "cohesive": (("approach", "line_load"), ("approach", "normal_force")),
}
"""Quantities across and up, by the problem that a dataset solves; the first pair that it has is drawn."""


def plot(data: xr.Dataset, axes: Axes | None = None, *, across: str | None = None, up: str | None = None) -> Axes:
    """Draw a quantity of a simulation against another.

    Parameters
    ----------
    data : xarray.Dataset
        Result of `contactsim.simulate`, or a dataset of the workflow.
    axes : matplotlib.axes.Axes, optional
        Where to draw; new axes by default.
    across, up : str, optional
        Variables to draw; by default pressure and contact area at a hard wall, approach and load along a path.

    Returns
    -------
    matplotlib.axes.Axes
        With a line for each member and variant, and labels with units.
    """
    if data.attrs.get("problem") not in QUANTITIES:
        allowed = "a result of `simulate` or of the workflow; `plot_characterisation` draws one of `characterise`"
        raise InputError("data", Words("another dataset"), allowed)
    pairs = QUANTITIES[data.attrs["problem"]]
    default_across, default_up = next((pair for pair in pairs if set(pair) <= set(data.variables)), pairs[0])
    names = across or default_across, up or default_up
    for name in names:
        if name not in data.variables:
            raise InputError("plot", name, f"a variable of the dataset: {', '.join(sorted(map(str, data.variables)))}")
    if axes is None:
        import matplotlib.pyplot as plt  # sets up a window system, which importing this package must not

        axes = plt.figure(layout="constrained").subplots()
    x, y = xr.broadcast(data[names[0]], data[names[1]])
    steps = data[names[0]].dims[-1] if data[names[0]].ndim == 1 else data.status.dims[-1]
    rest = [dim for dim in x.dims if dim != steps]
    stacked = [values.stack(line=rest).transpose(steps, "line") if rest else values for values in (x, y)]
    axes.plot(*(values.values for values in stacked), ".-")
    axes.set_xlabel(_label(data[names[0]]))
    axes.set_ylabel(_label(data[names[1]]))
    return axes


def _label(values: xr.DataArray) -> str:
    """Return the long name of a variable with its unit."""
    name, unit = values.attrs.get("long_name", values.name), values.attrs.get("units", "1")
    return name if unit == "1" else f"{name} ({unit})"
