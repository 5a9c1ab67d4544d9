"""Points of a drawn figure: where they are, to which curve they belong, and their values with errors as text.

They are read from the finished figure, so that a page can show the numbers under the cursor for every figure alike.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from matplotlib import colors
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D

from contactsim.figures import style
from contactsim.figures.plain_text import plain_text
from contactsim.grid import Array

DOTS_PER_INCH = 72
"""Units of a vector picture in an inch."""
MAX_POINTS = 240
"""Most points of a curve that can be pointed at; of more, as many are chosen evenly."""
NEUTRAL = {colors.to_hex(colour) for colour in (style.GREY, style.EXACT, style.LIGHT_GREY, "black")}
"""Colours of legend entries that explain a marker or a line, whatever its colour."""
NO_MARKER = ("None", "none", " ")


class Look(NamedTuple):
    """Colour, marker (empty for none), line style and opacity of a curve or of an entry of a legend."""

    colour: str
    marker: str = ""
    line: str = "-"
    opacity: float = 1.0


Entry = tuple[str, Look]


@dataclass(frozen=True)
class Curve:
    """A curve of a panel: its look, and its points with their errors (NaN where there is none)."""

    label: str
    look: Look
    x: Array
    y: Array
    error: Array


def figure_points(figure: Figure) -> list[dict[str, Any]]:
    """Return the points of a figure, curve by curve.

    The figure must have been drawn, so that its panels stand where they will be.

    Returns
    -------
    curves : of each its name and colour, the names of its axes, the places of its points, and x and y there as text

    Places count in units of the vector picture, from the upper left corner.
    """
    return [curve for axes in figure.axes for curve in _panel_points(axes, figure)]


def _panel_points(axes: Axes, figure: Figure) -> Iterator[dict[str, Any]]:
    """Yield the points of a panel, curve by curve."""
    legends = _legends(axes, figure)
    height = figure.get_figheight() * DOTS_PER_INCH
    left, right = sorted(axes.get_xlim())
    bottom, top = sorted(axes.get_ylim())
    for curve in _curves(axes):
        x, y = np.asarray(curve.x, float), np.asarray(curve.y, float)
        inside = np.flatnonzero((left <= x) & (x <= right) & (bottom <= y) & (y <= top))
        if not len(inside):
            continue
        chosen = inside[np.unique(np.linspace(0, len(inside) - 1, MAX_POINTS).astype(int))]
        places = axes.transData.transform(np.column_stack([x[chosen], y[chosen]])) * DOTS_PER_INCH / figure.dpi
        yield {
            "name": _name(curve, *legends),
            "colour": curve.look.colour,
            "axes": [plain_text(axes.get_xlabel()) or "x", plain_text(axes.get_ylabel()) or "y"],
            "places": [[round(float(across), 1), round(float(height - up), 1)] for across, up in places],
            "x": [f"{value:.4g}" for value in x[chosen]],
            "y": [_with_error(y[index], curve.error[index]) for index in chosen],
        }


def _curves(axes: Axes) -> Iterator[Curve]:
    """Yield the curves of a panel: those with error bars, other lines, and scattered points."""
    parts: set[Any] = set()
    for container in axes.containers:
        if isinstance(container, ErrorbarContainer) and container.lines[0] is not None:
            line, caps, bars = container.lines
            parts |= {line, *caps}
            yield _line_curve(line, str(container.get_label()), _vertical_errors(line, bars))
    for line in axes.lines:
        if line not in parts and line.get_visible() and line.get_transform() == axes.transData:
            yield _line_curve(line, str(line.get_label()), np.full(np.size(line.get_xdata()), np.nan))
    for points in axes.collections:
        faces = np.atleast_2d(np.asarray(points.get_facecolor(), float))
        if isinstance(points, PathCollection) and faces.size:
            x, y = np.ma.filled(np.ma.asarray(points.get_offsets(), float), np.nan).T
            look = Look(colors.to_hex(tuple(faces[0])))
            yield Curve(str(points.get_label()), look, x, y, np.full(len(x), np.nan))


def _line_curve(line: Line2D, label: str, error: Array) -> Curve:
    """Return a line as a curve."""
    return Curve(label, _look(line), np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float), error)


def _vertical_errors(line: Line2D, bars: Sequence[LineCollection]) -> Array:
    """Return half the height of the error bars at each point of a line."""
    error = np.full(np.size(line.get_xdata()), np.nan)
    for collection in bars:
        for index, segment in enumerate(collection.get_segments()):
            if len(segment) and segment[0][0] == segment[-1][0]:  # a bar with an end that is not finite has no points
                error[index] = (segment[-1][1] - segment[0][1]) / 2
    return error


def _look(line: Line2D) -> Look:
    """Return the look of a line."""
    marker = str(line.get_marker())
    opacity = line.get_alpha()
    return Look(
        colors.to_hex(line.get_color()),
        "" if marker in NO_MARKER else marker,
        str(line.get_linestyle()),
        1.0 if opacity is None else opacity,
    )


def _legends(axes: Axes, figure: Figure) -> tuple[list[Entry], list[Entry]]:
    """Return the entries of a panel's own legend, and those of all legends of the figure."""
    own = axes.get_legend()
    every = [legend for legend in (*(panel.get_legend() for panel in figure.axes), *figure.legends) if legend]
    return _entries(own) if own else [], [entry for legend in every for entry in _entries(legend)]


def _entries(legend: Legend) -> list[Entry]:
    """Return the lines and markers of a legend, with their texts."""
    pairs = zip(legend.legend_handles, legend.get_texts(), strict=False)
    return [(plain_text(text.get_text()), _look(line)) for line, text in pairs if isinstance(line, Line2D)]


def _name(curve: Curve, own: list[Entry], every: list[Entry]) -> str:
    """Return the name of a curve: its own label, or what legends say of its colour, opacity, marker and line.

    What a legend says of two looks that cannot be told apart is left out.

    Parameters
    ----------
    curve : with its look
    own, every : entries of the panel's legend and of all legends
    """
    if curve.label and not curve.label.startswith("_"):
        return plain_text(curve.label)
    look, dark = curve.look, [entry for entry in every if entry[1].colour in NEUTRAL]
    coloured = [[entry for entry in entries if _same_colour(entry[1], look)] for entries in (own, every)]
    marked = [entry for entry in dark if entry[1].marker == look.marker != ""]
    faint = [entry for entry in dark if entry[1].opacity == look.opacity < 1]
    dashed = [entry for entry in dark if entry[1].line == look.line != "-"]
    if any(entry[1].marker for entry in dashed):
        dashed = []
    names = [*_single(coloured[0] or coloured[1]), *_single(marked), *_single(faint), *_single(dashed)]
    return ", ".join(dict.fromkeys(names))


def _same_colour(entry: Look, look: Look) -> bool:
    """Return True where a coloured entry of a legend explains a curve."""
    return entry.colour == look.colour and look.colour not in NEUTRAL and entry.marker in ("", look.marker)


def _single(entries: list[Entry]) -> list[str]:
    """Return the text of entries if they all have the same one."""
    texts = list(dict.fromkeys(text for text, _ in entries))
    return texts if len(texts) == 1 else []


def _with_error(value: float, error: float) -> str:
    """Return a value with its error."""
    return f"{value:.4g} ± {error:.2g}" if np.isfinite(error) else f"{value:.4g}"
