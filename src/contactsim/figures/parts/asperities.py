"""Smooth adhesive asperities: traction across contacts and their size, both legs of the load by two laws, pull-offs."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.figures import style
from contactsim.figures.parts import load_curves as curves
from contactsim.observables.adhesion import LEGS

INDENTED = 10.0
"""Approach (nm) of the largest indentation, at which fields are kept."""
FRICTION = {0.0: "--", 0.1: "-.", 0.5: ":", 1.0: "-"}
"""Lines of ratios of works."""
FELT = 0.01
"""Part of the largest load below which a curve is not worth showing."""
COUPLING = {"coupled": "-", "uncoupled": "--"}


def friction(ratio: float) -> object:
    """Line of a ratio of works."""
    return FRICTION.get(round(float(ratio), 6), (0, (1, 3)))


def ratio_words(ratio: float) -> str:
    """A ratio of works in words."""
    return rf"$\varphi_t/\varphi_n={float(ratio):g}$"


def profiles(panel: Axes, parts: list[xr.Dataset], work: float) -> pd.DataFrame:
    """Normal traction over the strength across the contact, one curve a ratio of works."""
    rows, widest = [], 0.0
    for one in parts:
        radius, ratio = curves.radius(one), float(one.work_ratio)
        place, order = curves.centred(one)
        here = one.isel(member=0).sel(snapshot=INDENTED, method="nearest", tolerance=style.SAME)
        strength = float(one.strength.isel(member=0)) if "member" in one.strength.dims else float(one.strength)
        traction = here.normal_traction.values[order] / strength
        size = float(one.final_contact_length.isel(member=0))
        words = rf"{ratio_words(ratio)}, $l_{{\mathrm{{rep}}}}/R$ = {size / radius:.4f}"
        color = style.CONTACT if ratio else style.WHOLE
        panel.plot(place / radius, traction, color=color, ls=friction(ratio), lw=1.1, label=words)
        widest = max(widest, float(np.abs(place[np.abs(traction) > 0.01]).max()))
        rows.append(
            pd.DataFrame({"position": place, "normal_traction": traction * strength}).assign(
                work_ratio=ratio, contact_length=size
            )
        )
    panel.axhline(0.0, color=style.EXACT, lw=0.5)
    panel.set(xlim=(-1.1 * widest / radius, 1.1 * widest / radius), xlabel=r"$x/R$")
    panel.set_ylabel(r"$T_n/\sigma_{\max}$ (pull positive)")
    low, high = panel.get_ylim()
    panel.set_ylim(low, high + 0.28 * (high - low))
    panel.legend(loc="upper center")
    shown = pd.concat(rows)
    return shown[np.abs(shown.position) <= 1.1 * widest].assign(strength=work / np.e)


def sizes(parts: list[xr.Dataset]) -> pd.DataFrame:
    """Contact size over the radius at each ratio of works, with its grid error, sorted."""
    rows = []
    for one in parts:
        radius = curves.radius(one)
        found = {"work_ratio": one.work_ratio.values}
        found["size_ratio"] = one.final_contact_length.isel(member=0).values / radius
        error = one.get("final_contact_length_grid_error")
        found["error"] = np.full(one.work_ratio.size, np.nan) if error is None else error.values / radius
        rows.append(pd.DataFrame(found))
    return pd.concat(rows).sort_values("work_ratio", ignore_index=True)


def both_legs(panels: list[Axes], pair: tuple, color: str, panel: str, **place: float) -> pd.DataFrame:
    """Loading and unloading of the coupled and the uncoupled law."""
    rows = []
    for (name, line), one in zip(COUPLING.items(), pair, strict=True):
        for leg, axes in zip(LEGS, panels, strict=True):
            shown = curves.branch(axes, one.isel(member=0), leg, color=color, ls=line, lw=1.0)
            rows.append(shown.assign(panel=panel, law=name, leg=leg, **place))
    return pd.concat(rows)


def load_axes(axes: list[Axes], titles: tuple[str, ...]) -> None:
    """Labels and titles of panels of load against approach, from where the surfaces first or last pull."""
    for panel, title in zip(axes, titles, strict=True):
        points = np.concatenate([line.get_xydata() for line in panel.lines])
        felt = points[np.abs(points[:, 1]) > FELT * np.nanmax(np.abs(points[:, 1])), 0]
        panel.set_xlim(felt.min() - 2.0, felt.max() + 1.0)
        panel.axhline(0.0, color=style.EXACT, lw=0.5)
        panel.set(xlabel=r"approach $\delta/\delta_n$", ylabel=curves.LOAD_LABEL)
        panel.set_title(title, fontsize=9)
    style.letters(axes)


def pull_offs(panel: Axes, one: xr.Dataset, color: str) -> pd.DataFrame:
    """Pull-off on loading and on unloading against work, with grid errors as bars."""
    shown = pd.DataFrame({"work_of_separation": one.work_of_separation.values})
    for leg, fill in zip(LEGS, (color, "white"), strict=True):
        name = f"pull_off_load_{leg}"
        shown[name] = one[name].values
        error = one.get(f"{name}_grid_error")
        shown[f"{name}_grid_error"] = np.nan if error is None else error.values
        bars = curves.normalised(shown[f"{name}_grid_error"], one) if error is not None else None
        look = {"color": color, "marker": "o", "ms": 4, "mfc": fill, "lw": 0.7 if fill == color else 0.0}
        panel.errorbar(shown.work_of_separation, curves.normalised(shown[name], one), bars, elinewidth=0.8, **look)
    return shown
