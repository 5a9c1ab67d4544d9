"""Maps of a pressed surface: where it touches, how hard it presses there, how far apart it is elsewhere.

The colours are even to the eye and run from light, nothing, to dark. A grid finer than a picture is reduced by means
over square blocks of points, so a pixel tells the fraction of its points in contact and loses none of the load.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, ListedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

from contactsim.errors import InputError, is_number
from contactsim.figures import style
from contactsim.grid import Array
from contactsim.observables.contact import touching
from contactsim.solvers.base import Result
from contactsim.status import Status

PIXELS = 512
"""Most pixels along a side: what three panels beside each other can show."""
BAR = 0.3
"""Most of a panel's width that a scale bar takes."""
PREFIXES = {"p": 1e-12, "n": 1e-9, "µ": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3, "M": 1e6, "G": 1e9}


def _greys() -> ListedColormap:
    """White to black in equal steps of lightness (CIE 1976), which those of Matplotlib are not."""
    lightness = np.linspace(1.0, 0.0, 256)
    luminance = np.where(lightness > 0.08, ((lightness + 0.16) / 1.16) ** 3, lightness / 9.033)
    grey = np.where(luminance > 0.0031308, 1.055 * luminance ** (1 / 2.4) - 0.055, 12.92 * luminance)
    return ListedColormap(np.repeat(grey[:, None], 3, axis=1), name="even_greys")


COLOURS: dict[str, str | Colormap] = {"contact": _greys(), "pressure": "magma_r", "gap": "viridis_r"}
WORDS = {"contact": "fraction in contact", "pressure": r"pressure $p$", "gap": "gap $g$"}
MEANS = {"contact": r"$a_{\mathrm{rel}}$", "pressure": r"mean $p$", "gap": "mean $g$"}


@dataclass(frozen=True, eq=False)
class Solved:
    """One solved load of a surface: pressure and gap (ny, nx), periods along y and x, and the units of them."""

    pressure: Array
    gap: Array
    lengths: tuple[float, float]
    length_unit: str = "nm"
    pressure_unit: str = "GPa"

    def maps(self) -> dict[str, tuple[Array, str]]:
        """Name, values (ny, nx) and unit of each map; in contact, where the gap is none but for a residual, it is 0."""
        contact = touching(self.pressure)
        return {
            "contact": (contact.astype(float), ""),
            "pressure": (self.pressure, self.pressure_unit),
            "gap": (np.where(contact, 0.0, self.gap), self.length_unit),
        }


def draw(
    solution: Result | xr.Dataset,
    *,
    spacing: float | tuple[float, float] | None = None,
    length_unit: str = "nm",
    pressure_unit: str = "GPa",
    size: tuple[float, float] = (10.2, 3.0),
) -> Figure:
    """Contact, pressure and gap of a surface side by side, to be saved with `.savefig("maps.png")`.

    solution: what `contactsim.press` returned for a surface, together with the spacing of its points, one number or
    those along y and x; or one load of a dataset that keeps `fields`, as `data.isel(step=-1)`, which has its own.
    length_unit, pressure_unit: of a result's numbers; those made of m and Pa are shown with the prefix that fits.
    size: width and height, inches. InputError for a line, for several loads, and for what did not converge.
    """
    if isinstance(solution, Result):
        solved = _of_result(solution, spacing, length_unit, pressure_unit)
    elif (spacing, length_unit, pressure_unit) != (None, "nm", "GPa"):
        raise InputError("spacing, length_unit, pressure_unit", spacing, "none with a dataset: it has its own")
    else:
        solved = of_dataset(solution)
    figure = Figure(figsize=size, layout="constrained")
    panels(solved, list(figure.subplots(1, 3)))
    return figure


def _of_result(result: Result, spacing: object, length_unit: str, pressure_unit: str) -> Solved:
    _require_surface(result.pressure.ndim)
    _require_converged(result.status)
    both = [spacing] * 2 if np.ndim(spacing) == 0 else list(spacing)
    if len(both) != 2 or not all(is_number(step) and step > 0 for step in both):
        raise InputError("spacing", spacing, "the spacing that the surface was pressed with: a positive number or two")
    lengths = tuple(float(step) * count for step, count in zip(both, result.pressure.shape, strict=True))
    return Solved(result.pressure, result.gap, lengths, length_unit, pressure_unit)


def of_dataset(data: xr.Dataset) -> Solved:
    """The one solved load of a dataset with the variables pressure and gap; dimensions of one value are dropped."""
    _require_surface(2 if "length_y" in data else 1)
    if not {"pressure", "gap"} <= set(data):
        allowed = "a dataset with pressure and gap: of a study or a simulation that keeps `fields`"
        raise InputError("keep", sorted(map(str, data)), allowed)
    places = [name for name in data.pressure.dims if name not in ("y", "x")]
    for name in places:
        if data.sizes[name] > 1:
            raise InputError(str(name), data.sizes[name], "one value, since a map shows one: choose with .sel or .isel")
    one = data.squeeze(places)
    _require_converged(next(status for status in Status if status.value[0] == one.status))
    return Solved(one.pressure.values, one.gap.values, (float(one.length_y), float(one.length)))


def _require_surface(dimensions: int) -> None:
    if dimensions != 2:
        raise InputError("dimensions", dimensions, "2: maps are of surfaces, and this is a line")


def _require_converged(status: Status) -> None:
    if status is not Status.CONVERGED:
        raise InputError("status", status.sentence, "a solution that converged")


def panels(solved: Solved, axes: list[Axes]) -> pd.DataFrame:
    """Draw the three maps on axes of a figure with constrained layout; returns what they show, one row a map.

    mean, least, largest: of all points, in the units given; shown_least, shown_largest: ends of the colours;
    pixel_points: points along the side of a pixel.
    """
    figure = axes[0].figure
    kept = figure.get_layout_engine().get() | {"wspace": 0.04}
    figure.set_layout_engine("compressed", **kept)  # which heeds the fixed proportions
    rows, ny, nx = [], *solved.pressure.shape
    spacing = solved.lengths[0] / ny, solved.lengths[1] / nx
    block = -(-max(ny, nx) // PIXELS)
    extent = (0.0, -(-nx // block) * block * spacing[1], 0.0, -(-ny // block) * block * spacing[0])
    for panel, letter, (name, (values, unit)) in zip(axes, "abc", solved.maps().items(), strict=True):
        pixels = reduced(values, block)
        factor, shown_unit = fitting(max(values.max(), -values.min()), unit)
        low, high = min(pixels.min(), 0.0), pixels.max() if pixels.max() > 0 else 1 / factor
        low, high = (0.0, 1.0) if name == "contact" else (low, high)
        look = {"cmap": COLOURS[name], "vmin": low * factor, "vmax": high * factor}
        image = panel.imshow(pixels * factor, origin="lower", extent=extent, **look)
        panel.set(xlim=(0.0, solved.lengths[1]), ylim=(0.0, solved.lengths[0]), xticks=[], yticks=[])
        bracket = f" ({shown_unit})" if shown_unit else ""
        bar = figure.colorbar(image, ax=panel, label=WORDS[name] + bracket, aspect=22, pad=0.03)
        bar.locator = MaxNLocator(6, steps=[1, 2, 5, 10])
        style.letter(panel, letter)
        panel.set_title(f"{MEANS[name]} = {values.mean() * factor:.3g} {shown_unit}".rstrip(), loc="right", fontsize=8)
        scale_bar(panel, solved.lengths[1], solved.length_unit)
        numbers = {"mean": values.mean(), "least": values.min(), "largest": values.max()}
        shown = {"shown_least": low, "shown_largest": high, "pixel_points": block}
        rows.append({"map": name, "unit": unit or "1"} | numbers | shown)
    return pd.DataFrame(rows)


def reduced(values: Array, block: int) -> Array:
    """Means over square blocks of points, (ny, nx) to (ceil(ny/block), ceil(nx/block)); the last may be smaller."""
    for axis, count in enumerate(values.shape):
        starts = np.arange(0, count, block)
        sizes = np.diff(starts, append=count)
        values = np.add.reduceat(values, starts, axis=axis) / np.expand_dims(sizes, 1 - axis)
    return values


def fitting(largest: float, unit: str) -> tuple[float, str]:
    """Factor to, and name of, the unit in which a value is 1 to 1000; units that are not made of m or Pa stay."""
    base = "Pa" if unit.endswith("Pa") else "m"
    prefix = unit.removesuffix(base)
    if not unit.endswith(base) or prefix not in PREFIXES or not largest > 0:
        return 1.0, unit
    size = largest * PREFIXES[prefix] * (1 + 1e-12)
    best = max((name for name in PREFIXES if PREFIXES[name] <= size), key=PREFIXES.get, default=prefix)
    return PREFIXES[prefix] / PREFIXES[best], f"{best}{base}"


def round_length(most: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not above `most`."""
    power = 10.0 ** np.floor(np.log10(most))
    return max(digit * power for digit in (0.5, 1, 2, 5) if digit * power <= most * (1 + 1e-12))


def scale_bar(axes: Axes, width: float, unit: str) -> AnchoredSizeBar:
    """A bar of a round length below the left corner of a map of that width."""
    length = round_length(BAR * width)
    factor, shown_unit = fitting(length, unit)
    bar = AnchoredSizeBar(
        axes.transData,
        length,
        f"{length * factor:.3g} {shown_unit}".rstrip(),
        loc="upper left",
        pad=0.0,
        borderpad=0.0,
        sep=3,
        frameon=False,
        size_vertical=width / 150,
        color=style.EXACT,
        bbox_to_anchor=(0.0, -0.03),
        bbox_transform=axes.transAxes,
    )
    axes.add_artist(bar)
    return bar
