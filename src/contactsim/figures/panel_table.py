"""The table of what the panels of a figure show, point by point."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from contactsim.figures.drawn import Curve, panels_of
from contactsim.figures.plain_text import plain_text
from contactsim.figures.points import named_curves


def panel_table(figure: Figure) -> pd.DataFrame:
    """Return what the panels of a figure show, from which each can be plotted again.

    Returns
    -------
    table : one row a point, with

        point : panel, number of the curve in it and number of the point in that, which tell all rows apart
        panel, curve : letter of the panel, name of the curve
        x, y, value : coordinates, and on maps what the colour stands for; a guide across the panel has one coordinate
        x_low, x_high, y_low, y_high : ends of the error bars
        relative_error : half the height of the error bar over y
        x_label, y_label, value_label, x_scale, y_scale : of the axes; scales are linear, log or symlog
    """
    tables = []
    numbers: dict[str, int] = {}
    for letter, axes in panels_of(figure):
        words = {"x_label": plain_text(axes.get_xlabel()), "y_label": plain_text(axes.get_ylabel())}
        scales = {"x_scale": axes.get_xscale(), "y_scale": axes.get_yscale()}
        for name, curve in named_curves(axes, figure):
            numbers[letter] = numbers.get(letter, 0) + 1
            place = {"panel": letter, "curve": name} | words | {"value_label": curve.value_label} | scales
            tables.append(_curve_table(curve, f"{letter}{numbers[letter]}").assign(**place))
    return pd.concat(tables)[COLUMNS] if tables else pd.DataFrame(columns=COLUMNS)


COLUMNS = [
    *("point", "panel", "curve", "x", "y", "value", "x_low", "x_high", "y_low", "y_high", "relative_error"),
    *("x_label", "y_label", "value_label", "x_scale", "y_scale"),
]
"""Columns of the table of a figure's panels."""
LEAST_PERCENT = 0.01
"""Smallest error that words tell from none, per cent."""


def error_texts(table: pd.DataFrame) -> list[str]:
    """Return the median error bar of each panel, relative to the values, the least and the largest; nothing without.

    table: of `panel_table`
    """
    medians = (100 * table.relative_error.groupby(table.panel).median()).dropna()
    ends = list(dict.fromkeys(_percent(end) for end in (medians.min(), medians.max()))) if len(medians) else []
    return [f"median error bar {' to '.join(ends)} %"] if ends else []


def _percent(value: float) -> str:
    """Return a number of per cent with one digit."""
    return f"{float(f'{value:.1g}'):g}" if value >= LEAST_PERCENT else f"< {LEAST_PERCENT:g}"


def _curve_table(curve: Curve, prefix: str) -> pd.DataFrame:
    """Return the points of one curve that can be seen."""
    table = pd.DataFrame({"x": curve.x, "y": curve.y, "value": curve.values if curve.values.size else np.nan})
    table["x_low"], table["x_high"] = curve.x_bar.T
    table["y_low"], table["y_high"] = curve.y_bar.T
    table["relative_error"] = curve.y_error / np.abs(np.where(curve.y == 0, np.nan, curve.y))
    table = table if curve.is_guide else table[np.isfinite(curve.x) & np.isfinite(curve.y)]
    return table.assign(point=[f"{prefix}-{number}" for number in range(1, len(table) + 1)])
