"""Read from a finished figure what its panels show: curves with error bars, bands, bars, maps and guides."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from matplotlib import colors
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import FillBetweenPolyCollection, LineCollection, PathCollection, QuadMesh
from matplotlib.container import BarContainer, ErrorbarContainer
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from contactsim.figures import style
from contactsim.figures.maps import block_means
from contactsim.figures.plain_text import plain_text
from contactsim.grid import Array

MAX_CELLS = 64
"""Most cells of a map along a side; of a larger one, means over square blocks are given."""
NO_MARKER = ("None", "none", " ")
COLOUR_BAR = "<colorbar>"
"""Label that Matplotlib gives to the axes of a colour bar."""
AUTOMATIC_NAME = re.compile(r"_(child\d+|container\d+|nolegend_)?")
"""Labels that Matplotlib gives to what has none."""


class Look(NamedTuple):
    """Colour, marker (empty for none), line style and opacity of a curve or of an entry of a legend."""

    colour: str
    marker: str = ""
    line: str = "-"
    opacity: float = 1.0


@dataclass(frozen=True)
class Curve:
    """What a panel draws in one go: a curve, a band, bars, the cells of a map, or a guide across the panel.

    Attributes
    ----------
    name : plain text of its label; empty without one
    x, y : (points,); NaN along a guide across the panel
    x_bar, y_bar : (points, 2), ends of the error bars; NaN where there is none
    values : (points,), what the colours of a map stand for; empty without a map
    value_label : of the colour bar
    """

    name: str
    look: Look
    x: Array
    y: Array
    x_bar: Array
    y_bar: Array
    values: Array = field(default_factory=lambda: np.empty(0))
    value_label: str = ""

    @property
    def y_error(self) -> Array:
        """Half the heights of the error bars, (points,); NaN where there is none."""
        return np.diff(self.y_bar, axis=1)[:, 0] / 2

    @property
    def is_guide(self) -> bool:
        """True for a line from one side of the panel to the other."""
        return bool(np.isnan(self.x).all() or np.isnan(self.y).all())


def panels_of(figure: Figure) -> Iterator[tuple[str, Axes]]:
    """Yield the letter and the axes of each panel; a second axis of a panel has its letter, a colour bar none."""
    letters: dict[Any, str] = {}
    for axes in figure.axes:
        if axes.get_label() != COLOUR_BAR:
            yield letters.setdefault(axes.get_subplotspec(), chr(ord("a") + len(letters))), axes


def panel_curves(axes: Axes) -> Iterator[Curve]:
    """Yield what a panel draws; of points at one place that with an error comes first."""
    parts: set[Any] = set()
    for container in axes.containers:
        if isinstance(container, ErrorbarContainer):
            yield _with_bars(container, parts)
        elif isinstance(container, BarContainer):
            yield _bars(container, axes)
    for points in axes.collections:
        if isinstance(points, PathCollection) and np.size(points.get_facecolor()):
            x, y = np.ma.filled(np.ma.asarray(points.get_offsets(), float), np.nan).T
            yield _curve(points, Look(colors.to_hex(tuple(np.atleast_2d(points.get_facecolor())[0]))), x, y)
        elif isinstance(points, FillBetweenPolyCollection):
            yield from _band(points)
        elif isinstance(points, QuadMesh):
            yield from _mesh(points)
    for line in axes.lines:
        if line not in parts and line.get_visible() and np.size(line.get_xdata()):
            yield from _line(line, axes)
    for image in axes.images:
        yield from _image(image)


def own_name(artist: Any) -> str:
    """Return the label of an artist as plain text; a leading underscore, which keeps it out of legends, is left out."""
    label = str(artist.get_label() or "")
    return "" if AUTOMATIC_NAME.fullmatch(label) else plain_text(label.removeprefix("_"))


def line_look(line: Line2D) -> Look:
    """Return the look of a line."""
    marker = str(line.get_marker())
    opacity = line.get_alpha()
    return Look(
        colors.to_hex(line.get_color()),
        "" if marker in NO_MARKER else marker,
        str(line.get_linestyle()),
        1.0 if opacity is None else opacity,
    )


def _curve(artist: Any, look: Look, x: Any, y: Any, **rest: Any) -> Curve:
    """Return a curve; without bars unless they are given."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    none = np.full((x.size, 2), np.nan)
    return Curve(own_name(artist), look, x, y, **{"x_bar": none, "y_bar": none} | rest)


def _line(line: Line2D, axes: Axes) -> Iterator[Curve]:
    """Yield a line in the coordinates of the data, or a guide across the panel."""
    x, y = np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)
    if line.get_transform() == axes.transData:
        yield _curve(line, line_look(line), x, y)
    elif line.get_transform() == axes.get_yaxis_transform(which="grid"):
        yield _curve(line, line_look(line), [np.nan], y[:1])
    elif line.get_transform() == axes.get_xaxis_transform(which="grid"):
        yield _curve(line, line_look(line), x[:1], [np.nan])


def _with_bars(container: ErrorbarContainer, parts: set[Any]) -> Curve:
    """Return a curve with error bars; its lines are added to parts."""
    line, caps, collections = container.lines
    parts |= {line, *caps}
    if line is None:
        (bars,) = collections
        ends = np.array([segment for segment in bars.get_segments() if len(segment)]).reshape(-1, 2, 2)
        look = Look(colors.to_hex(tuple(np.atleast_2d(bars.get_color())[0])))
        return _curve(container, look, ends[:, 0, 0], ends[:, :, 1].mean(axis=1), y_bar=ends[:, :, 1])
    count = np.size(line.get_xdata())
    both = {name: np.full((count, 2), np.nan) for name in ("x_bar", "y_bar")}
    for collection in collections:
        _read_bars(collection, both)
    return _curve(container, line_look(line), line.get_xdata(), line.get_ydata(), **both)


def _read_bars(collection: LineCollection, both: dict[str, Array]) -> None:
    """Read the ends of error bars into arrays of those along x and y."""
    for index, segment in enumerate(collection.get_segments()):
        if len(segment):  # a bar with an end that is not finite has no points
            (x_low, y_low), (x_high, y_high) = segment[0], segment[-1]
            if x_low == x_high:
                both["y_bar"][index] = y_low, y_high
            else:
                both["x_bar"][index] = x_low, x_high


def _bars(container: BarContainer, axes: Axes) -> Curve:
    """Return the ends of bars as a curve."""
    boxes: Sequence[Rectangle] = container.patches
    look = Look(colors.to_hex(boxes[0].get_facecolor()), opacity=boxes[0].get_alpha() or 1.0)
    if container.orientation == "horizontal":
        ends = [(box.get_x() + box.get_width(), box.get_y() + box.get_height() / 2) for box in boxes]
    else:
        ends = [(box.get_x() + box.get_width() / 2, box.get_y() + box.get_height()) for box in boxes]
    return _curve(container, look, *np.transpose(ends))


def _band(band: FillBetweenPolyCollection) -> Iterator[Curve]:
    """Yield the middles of a band that has a name, with its edges as bars; without a name it is only shading."""
    look = Look(colors.to_hex(tuple(np.atleast_2d(band.get_facecolor())[0])), opacity=band.get_alpha() or 1.0)
    edges = []
    for path in band.get_paths() if own_name(band) else ():
        corners = np.asarray(path.vertices, float)  # start, one edge, end, the other edge backwards, start
        count = (len(corners) - 3) // 2
        edges.append(np.column_stack([corners[1 : count + 1], corners[count + 2 : 2 * count + 2, 1][::-1]]))
    if edges:
        x, *ends = np.concatenate(edges).T
        bar = np.sort(np.transpose(ends), axis=1)
        yield _curve(band, look, x, bar.mean(axis=1), y_bar=bar)


def _mesh(mesh: QuadMesh) -> Iterator[Curve]:
    """Yield the cells of a coloured mesh that has a colour bar."""
    values = _without_mask(mesh)
    corners = np.asarray(mesh.get_coordinates(), float)
    if corners.shape[:2] != values.shape:  # else colours run from corner to corner
        corners = (corners[1:, 1:] + corners[:-1, :-1]) / 2
    yield from _map(mesh, corners[..., 0], corners[..., 1], values)


def _image(image: AxesImage) -> Iterator[Curve]:
    """Yield the pixels of an image that has a colour bar."""
    values = _without_mask(image)
    left, right, bottom, top = image.get_extent()
    rows, columns = values.shape
    x = left + (np.arange(columns) + 0.5) / columns * (right - left)
    y = bottom + (np.arange(rows) + 0.5) / rows * (top - bottom)
    across, up = np.meshgrid(x, y)
    yield from _map(image, across, up, values)


def _without_mask(mappable: ScalarMappable) -> Array:
    """Return what the colours of a map stand for; NaN where it is masked."""
    return np.asarray(np.ma.filled(np.ma.asarray(mappable.get_array(), float), np.nan))


def _map(mappable: ScalarMappable, x: Array, y: Array, values: Array) -> Iterator[Curve]:
    """Yield a map, (rows, columns), as points with values: means over square blocks where it is large."""
    if mappable.colorbar is None:
        return
    block = -(-max(values.shape) // MAX_CELLS)
    x, y, values = (block_means(part, block).ravel() for part in (x, y, values))
    bar = mappable.colorbar.ax
    label = plain_text(bar.get_ylabel() or bar.get_xlabel())
    yield _curve(mappable, Look(style.EXACT), x, y, values=values, value_label=label)
