"""Maps of a pressed surface: contact, pressure and gap.

Lightness falls evenly from light (zero) to dark. A grid finer than the picture is reduced by means over square blocks
of points: a pixel shows the fraction of its points in contact, and no load is lost.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, ListedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from contactsim.errors import InputError, is_number
from contactsim.figures import style
from contactsim.figures.parts.scale_bar import add_scale_bar, fitting_unit
from contactsim.grid import Array
from contactsim.observables.contact import touching
from contactsim.status import Status

if TYPE_CHECKING:
    from contactsim.solvers.base import Result

PIXELS = 512
"""Largest number of pixels along a side: what three panels beside each other can show."""
RESOLUTION = 200
"""Dots an inch."""


def _greys() -> ListedColormap:
    """Return colours from white to black in equal steps of lightness (CIE 1976), unlike Matplotlib's greys."""
    lightness = np.linspace(1.0, 0.0, 256)
    luminance = np.where(lightness > 0.08, ((lightness + 0.16) / 1.16) ** 3, lightness / 9.033)
    grey = np.where(luminance > 0.0031308, 1.055 * luminance ** (1 / 2.4) - 0.055, 12.92 * luminance)
    return ListedColormap(np.repeat(grey[:, None], 3, axis=1), name="even_greys")


COLOURS: dict[str, str | Colormap] = {"contact": _greys(), "pressure": "magma_r", "gap": "viridis_r"}
LABELS = {"contact": "fraction in contact", "pressure": r"pressure $p$", "gap": "gap $g$"}
MEANS = {"contact": r"$a_{\mathrm{rel}}$", "pressure": r"mean $p$", "gap": "mean $g$"}


@dataclass(frozen=True, eq=False)
class SurfaceFields:
    """Fields of one solved load of a surface.

    pressure, gap: (ny, nx); lengths: periods along y and x; length_unit, pressure_unit: of these numbers.
    """

    pressure: Array
    gap: Array
    lengths: tuple[float, float]
    length_unit: str = "nm"
    pressure_unit: str = "GPa"

    @classmethod
    def of_result(
        cls, result: Result, spacing: float | tuple[float, float], length_unit: str, pressure_unit: str
    ) -> SurfaceFields:
        """Return the fields of a result of `contactsim.press`; spacing: of its points, one number or along y and x."""
        _require_surface(result.pressure.ndim)
        _require_converged(result.status)
        steps = np.broadcast_to(np.asarray(spacing, object), 2) if np.size(spacing) in (1, 2) else [None]
        if not all(is_number(step) and step > 0 for step in steps):
            allowed = "the spacing that the surface was pressed with: a positive number or two"
            raise InputError("spacing", spacing, allowed)
        ny, nx = result.pressure.shape
        lengths = float(steps[0]) * ny, float(steps[1]) * nx
        return cls(result.pressure, result.gap, lengths, length_unit, pressure_unit)

    @classmethod
    def of_dataset(cls, data: xr.Dataset) -> SurfaceFields:
        """Return the fields of the one solved load of a dataset; dimensions with one value are dropped."""
        _require_surface(2 if "length_y" in data else 1)
        if not {"pressure", "gap"} <= set(data):
            allowed = "a dataset with pressure and gap: of a study or a simulation that keeps `fields`"
            raise InputError("keep", sorted(map(str, data)), allowed)
        dims = [dim for dim in data.pressure.dims if dim not in ("y", "x")]
        for dim in dims:
            if data.sizes[dim] > 1:
                allowed = "one value, since a map shows one: choose with .sel or .isel"
                raise InputError(str(dim), data.sizes[dim], allowed)
        load = data.squeeze(dims)
        _require_converged(next(status for status in Status if status.value[0] == load.status))
        return cls(load.pressure.values, load.gap.values, (float(load.length_y), float(load.length)))

    def maps(self) -> dict[str, tuple[Array, str]]:
        """Return values (ny, nx) and unit of each map; the gap in contact, a residual of the solver, is set to 0."""
        contact = touching(self.pressure)
        return {
            "contact": (contact.astype(float), ""),
            "pressure": (self.pressure, self.pressure_unit),
            "gap": (np.where(contact, 0.0, self.gap), self.length_unit),
        }


def _require_surface(dimensions: int) -> None:
    """Refuse a line."""
    if dimensions != 2:
        raise InputError("dimensions", dimensions, "2: maps are of surfaces, and this is a line")


def _require_converged(status: Status) -> None:
    """Refuse a solution that did not converge."""
    if status is not Status.CONVERGED:
        raise InputError("status", status.sentence, "a solution that converged")


def plot_maps(data: xr.Dataset, *, size: tuple[float, float] = (10.2, 3.0)) -> Figure:
    """Return a figure with contact, pressure and gap of one load of a surface side by side.

    Parameters
    ----------
    data : one load of a dataset that keeps `fields`, such as `data.isel(step=-1)`
    size : width and height, inches

    Raises
    ------
    InputError
        for a line, for several loads, without fields, and for a load that did not converge
    """
    return _figure(SurfaceFields.of_dataset(data), size)


def plot_result(
    result: Result,
    *,
    spacing: float | tuple[float, float],
    length_unit: str = "nm",
    pressure_unit: str = "GPa",
    size: tuple[float, float] = (10.2, 3.0),
) -> Figure:
    """Return a figure with contact, pressure and gap of a pressed surface side by side.

    Parameters
    ----------
    result : of `contactsim.press` for a surface
    spacing : of its points, one number or those along y and x
    length_unit, pressure_unit : of the numbers; units of m and Pa are shown with the prefix that fits
    size : width and height, inches

    Raises
    ------
    InputError
        for a line, for another spacing than a positive number or two, and for a result that did not converge
    """
    return _figure(SurfaceFields.of_result(result, spacing, length_unit, pressure_unit), size)


@mpl.rc_context(style.RC_PARAMS)
def _figure(fields: SurfaceFields, size: tuple[float, float]) -> Figure:
    """Return the maps in a figure of their own."""
    figure = Figure(figsize=size, layout="constrained", dpi=RESOLUTION)
    plot_fields(fields, list(figure.subplots(1, 3)))
    figure.draw_without_rendering()  # ticks take their look when they are first drawn
    return figure


def plot_fields(fields: SurfaceFields, axes: list[Axes]) -> pd.DataFrame:
    """Plot the maps of one load on three axes of a figure with constrained layout.

    Returns
    -------
    table : one row a map; mean, least and largest of all points, in the unit given; shown_least, shown_largest: ends
        of the colours; pixel_points: points along the side of a pixel
    """
    figure = axes[0].figure
    constrained = figure.get_layout_engine().get() | {"wspace": 0.04}
    figure.set_layout_engine("compressed", **constrained)  # which heeds the fixed proportions
    block = -(-max(fields.pressure.shape) // PIXELS)
    rows = [
        _plot_map(panel, name, values, unit, fields, block)
        for panel, (name, (values, unit)) in zip(axes, fields.maps().items(), strict=True)
    ]
    style.add_letters(axes)
    return pd.DataFrame(rows)


def _plot_map(
    axes: Axes, name: str, values: Array, unit: str, fields: SurfaceFields, block: int
) -> dict[str, float | str]:
    """Plot one map with its colour bar and scale bar; return what it shows."""
    (ny, nx), (length_y, length_x) = values.shape, fields.lengths
    extent = (0.0, -(-nx // block) * block * (length_x / nx), 0.0, -(-ny // block) * block * (length_y / ny))
    pixels = block_means(values, block)
    factor, shown_unit = fitting_unit(max(values.max(), -values.min()), unit)
    low, high = min(pixels.min(), 0.0), pixels.max() if pixels.max() > 0 else 1 / factor
    low, high = (0.0, 1.0) if name == "contact" else (low, high)
    look = {"cmap": COLOURS[name], "vmin": low * factor, "vmax": high * factor}
    image = axes.imshow(pixels * factor, origin="lower", extent=extent, label=LABELS[name], **look)
    if name == "gap":
        _blacken_contact(axes, block_means(touching(fields.pressure).astype(float), block), extent)
    axes.set(xlim=(0.0, length_x), ylim=(0.0, length_y), xticks=[], yticks=[])
    label = LABELS[name] + (f" ({shown_unit})" if shown_unit else "")
    bar = axes.figure.colorbar(image, ax=axes, label=label, aspect=22, pad=0.03)
    bar.locator = MaxNLocator(6, steps=[1, 2, 5, 10])
    axes.set_title(f"{MEANS[name]} = {values.mean() * factor:.3g} {shown_unit}".rstrip(), loc="right", fontsize=8)
    add_scale_bar(axes, length_x, fields.length_unit)
    numbers = {"mean": values.mean(), "least": values.min(), "largest": values.max()}
    return (
        {"map": name, "unit": unit or "1"}
        | numbers
        | {"shown_least": low, "shown_largest": high, "pixel_points": block}
    )


def _blacken_contact(axes: Axes, contact: Array, extent: tuple[float, float, float, float]) -> None:
    """Draw pixels black of which more than half is in contact; contact: part of each pixel in contact."""
    in_contact = np.ma.masked_less_equal(contact, 0.5)
    look: dict[str, Any] = {"cmap": ListedColormap(["black"]), "vmin": 0.0, "vmax": 1.0, "label": "_contact"}
    axes.imshow(in_contact, origin="lower", extent=extent, **look)


def block_means(values: Array, block: int) -> Array:
    """Return means over square blocks of points, (ny, nx) to (ceil(ny/block), ceil(nx/block)).

    The last blocks of a row or column may be smaller.
    """
    for axis, count in enumerate(values.shape):
        starts = np.arange(0, count, block)
        sizes = np.diff(starts, append=count)
        values = np.add.reduceat(values, starts, axis=axis) / np.expand_dims(sizes, 1 - axis)
    return values
