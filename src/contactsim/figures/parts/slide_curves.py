"""Slides as curves: force, load and contact against what has been slid, in the thesis's own numbers."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim import dataset, reference
from contactsim.analysis.ensemble import converged
from contactsim.grid import Array

MODULUS, START = 70.0, 10.0
"""Young's modulus (GPa) over which forces are given, and δ0 (nm) over which approaches are."""
SLIDE = r"$\bar U_x=U_x/w$"
FORCE = r"$\bar F=F/(wE)$"
AREA = r"contact $\bar A=A/w$"
BARELY = 0.5
"""Part of the way to the onset at which stage B is taken; C lies half way from there to the onset."""


def curve(one: xr.Dataset) -> pd.DataFrame:
    """The states of a slide: slide in nm and over the period, force, load, area, edges of the contact over the period.

    one: one member of one variant; states that did not converge are NaN.
    """
    part = one.isel(step=np.flatnonzero(np.isfinite(one.sliding_distance.values)))
    period = float(one.length)
    numbers = {name: converged(part[name], part).values for name in NUMBERS}
    found = {"slide": part.sliding_distance.values, "relative_slide": part.sliding_distance.values / period}
    found |= {word: numbers[name] / period / (MODULUS if is_force else 1) for name, (word, is_force) in NUMBERS.items()}
    return pd.DataFrame(found)


NUMBERS = {
    "friction_force": ("force", True),
    "line_load": ("load", True),
    "contact_length": ("area", False),
    "contact_trailing_edge": ("trailing", False),
    "contact_leading_edge": ("leading", False),
}
"""What is read off states, its name in a curve, and whether it is a force."""


def stages(one: xr.Dataset, states: pd.DataFrame) -> list[int]:
    """The states A to E of a slide: before it, peeling, before the first slip, and after it."""
    slips = one.event_sliding_distance.dropna("event").values
    after = int(np.searchsorted(states.slide.values, slips[0] - 1e-9)) if slips.size else len(states) - 1
    before = after - 1
    half = int(BARELY * before)
    return [0, half, (half + before) // 2, before, after]


def exact_flat(one: xr.Dataset, slides: Array) -> Array:
    """Force over the period and `MODULUS` of the exact slide of a flat."""
    known = dataset.settings_of(one)
    law = known["cohesive_zone"] | {"work_ratio": float(one.work_ratio)}
    body = known["counter_body"]
    stiffness = float(one.counter_body_youngs_modulus) / (2 * (1 + body["poisson_ratio"])) / body["thickness"]
    strength = law["work_of_separation"] * law["work_ratio"] / law["tangential_length"]
    lattice = known["pairing"]["lattice_constant"]
    return reference.uniform_slide(slides, stiffness, strength, lattice, law["tangential_length"]) / MODULUS


def headroom(axes: Axes, share: float) -> None:
    """Room above the curves for a legend, as a part of their range."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + share * (high - low))
