"""Scale bars of maps, with round lengths and units that fit."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

from contactsim.figures import style

BAR_WIDTH = 0.3
"""Largest width of a scale bar over that of its panel."""
PREFIXES = {"p": 1e-12, "n": 1e-9, "µ": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3, "M": 1e6, "G": 1e9}


def fitting_unit(value: float, unit: str) -> tuple[float, str]:
    """Return the factor to the unit in which a value is 1 to 1000, and that unit.

    A unit that is not made of m or Pa stays as it is.
    """
    base = "Pa" if unit.endswith("Pa") else "m"
    prefix = unit.removesuffix(base)
    if not unit.endswith(base) or prefix not in PREFIXES or not value > 0:
        return 1.0, unit
    size = value * PREFIXES[prefix] * (1 + 1e-12)
    best = max((name for name in PREFIXES if PREFIXES[name] <= size), key=PREFIXES.__getitem__, default=prefix)
    return PREFIXES[prefix] / PREFIXES[best], f"{best}{base}"


def round_length(limit: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is not above a limit."""
    power = 10.0 ** np.floor(np.log10(limit))
    return float(max(digit * power for digit in (0.5, 1, 2, 5) if digit * power <= limit * (1 + 1e-12)))


def add_scale_bar(axes: Axes, width: float, unit: str) -> AnchoredSizeBar:
    """Add a bar of a round length below the left corner of a map of that width."""
    length = round_length(BAR_WIDTH * width)
    factor, shown_unit = fitting_unit(length, unit)
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
