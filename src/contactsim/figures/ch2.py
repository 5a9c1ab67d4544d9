"""Chapter 2: tractions of the interface. Each function plots one figure and returns the numbers that it shows."""

from __future__ import annotations

import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.analysis.scales import LawScales
from contactsim.figures import style
from contactsim.figures.parts import law_curves
from contactsim.reference import adhesion

UNEQUAL_WORKS, COMPLETE_SHEAR = 0.5, 5.0
"""Ratio of works at which another law keeps a normal traction after complete shear failure, at that slip over δt."""


def fig_2_2(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot normal tractions at fixed tangential gaps, and tangential at normal ones (thesis Fig. 2.2).

    Dots: the strengths of Eq. 2.18.
    """
    table = law_curves.plot_tractions(data, axes)
    law = LawScales.of(data)
    opening = data.opening.values / law.normal_length
    remainder = adhesion.xu_needleman_normal(opening, COMPLETE_SHEAR, UNEQUAL_WORKS)
    axes[0].plot(
        opening, remainder, color=style.GREY, lw=1.0, ls=":", label="_Xu–Needleman after complete shear failure"
    )
    style.add_letters(axes)
    traction = remainder * law.work_of_separation / law.normal_length
    curve = pd.DataFrame({"gap": data.opening.values, "xu_needleman_traction": traction})
    failed = curve.assign(component="normal", fixed_gap=COMPLETE_SHEAR * law.tangential_length)
    return pd.concat([table, failed])


def footer(data: xr.Dataset) -> str:
    """Return the law of the curves; nothing is simulated."""
    return law_curves.footer(data)
