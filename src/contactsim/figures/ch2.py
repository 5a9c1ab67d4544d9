"""Chapter 2: tractions of the interface. Each function plots one figure and returns the numbers that it shows."""

from __future__ import annotations

import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.figures import style
from contactsim.figures.parts import law_curves


def fig_2_2(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot normal tractions at fixed tangential gaps, and tangential at normal ones (thesis Fig. 2.2).

    Dots: the strengths of Eq. 2.18.
    """
    table = law_curves.plot_tractions(data, axes)
    style.add_letters(axes)
    return table


def footer(data: xr.Dataset) -> str:
    """Return the law of the curves; nothing is simulated."""
    return law_curves.footer(data)
