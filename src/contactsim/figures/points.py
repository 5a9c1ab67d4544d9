"""Points of a drawn figure: where they are, to which curve they belong, and their values with errors as text.

They are read from the finished figure, so that a page can show the numbers under the cursor for every figure alike.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib import colors
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D

from contactsim.figures import style
from contactsim.figures.drawn import Curve, Look, line_look, panel_curves, panels_of
from contactsim.figures.plain_text import plain_text

DOTS_PER_INCH = 72
"""Units of a vector picture in an inch."""
MAX_POINTS = 240
"""Most points of a curve that can be pointed at; of more, as many are chosen evenly."""
NEUTRAL = {colors.to_hex(colour) for colour in (style.GREY, style.EXACT, style.LIGHT_GREY, "black")}
"""Colours of legend entries that explain a marker or a line, whatever its colour."""
Entry = tuple[str, Look]


def figure_points(figure: Figure) -> list[dict[str, Any]]:
    """Return the points of a figure, curve by curve.

    The figure must have been drawn, so that its panels stand where they will be.

    Returns
    -------
    curves : of each its name and colour, the names of its axes, the places of its points, and x and y there as text; of
        a map the values too

    Places count in units of the vector picture, from the upper left corner.
    """
    return [curve for _, axes in panels_of(figure) for curve in _panel_points(axes, figure)]


def _panel_points(axes: Axes, figure: Figure) -> Iterator[dict[str, Any]]:
    """Yield the points of a panel, curve by curve."""
    height = figure.get_figheight() * DOTS_PER_INCH
    left, right = sorted(axes.get_xlim())
    bottom, top = sorted(axes.get_ylim())
    for name, curve in named_curves(axes, figure):
        x, y = curve.x, curve.y
        inside = np.flatnonzero((left <= x) & (x <= right) & (bottom <= y) & (y <= top))
        if not len(inside):
            continue
        is_map = curve.values.size > 0
        chosen = inside if is_map else inside[np.unique(np.linspace(0, len(inside) - 1, MAX_POINTS).astype(int))]
        places = axes.transData.transform(np.column_stack([x[chosen], y[chosen]])) * DOTS_PER_INCH / figure.dpi
        names = [plain_text(axes.get_xlabel()) or "x", plain_text(axes.get_ylabel()) or "y"]
        points = {
            "name": name,
            "colour": curve.look.colour,
            "axes": [*names, curve.value_label] if is_map else names,
            "places": [[round(float(across), 1), round(float(height - up), 1)] for across, up in places],
            "x": [f"{value:.4g}" for value in x[chosen]],
            "y": [_with_error(*pair) for pair in zip(y[chosen], curve.y_error[chosen], strict=True)],
        }
        yield points | ({"values": [f"{value:.3g}" for value in curve.values[chosen]]} if is_map else {})


def named_curves(axes: Axes, figure: Figure) -> Iterator[tuple[str, Curve]]:
    """Yield the curves of a panel, each with its name."""
    legends = _legends(axes, figure)
    for curve in panel_curves(axes):
        yield _name(curve, *legends), curve


def _legends(axes: Axes, figure: Figure) -> tuple[list[Entry], list[Entry]]:
    """Return the entries of a panel's own legend, and those of all legends of the figure."""
    own = axes.get_legend()
    every = [legend for legend in (*(panel.get_legend() for panel in figure.axes), *figure.legends) if legend]
    return _entries(own) if own else [], [entry for legend in every for entry in _entries(legend)]


def _entries(legend: Legend) -> list[Entry]:
    """Return the lines and markers of a legend, with their texts."""
    pairs = zip(legend.legend_handles, legend.get_texts(), strict=False)
    return [(plain_text(text.get_text()), line_look(line)) for line, text in pairs if isinstance(line, Line2D)]


def _name(curve: Curve, own: list[Entry], every: list[Entry]) -> str:
    """Return the name of a curve: its own label, or what legends say of its colour, opacity, marker and line.

    What a legend says of two looks that cannot be told apart is left out.

    Parameters
    ----------
    curve : with its look
    own, every : entries of the panel's legend and of all legends
    """
    if curve.name:
        return curve.name
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
