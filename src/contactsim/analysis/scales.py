"""Scales of a study: the lengths, works and moduli that its dataset is divided by, from the settings stored with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.grid import Array
from contactsim.reference import adhesion, springs

THICKNESS, WORK_UNIT = 1000.0, 1.0
"""Thickness of the bodies (nm) and φ0 (N/m) that make the thesis's loads numbers."""


@dataclass(frozen=True)
class LawScales:
    """Lengths (nm) and works (N/m) of a cohesive zone law.

    work_ratio: tangential over normal work of separation φt/φn; both works are those of a study that varies neither.
    """

    normal_length: float
    tangential_length: float
    work_of_separation: float
    work_ratio: float

    @classmethod
    def of(cls, data: xr.Dataset) -> LawScales:
        """Return the scales of the law of a study; of a tabulated law, those of the table."""
        settings = dataset.settings_of(data)
        law = settings[settings["effects"][0]] if "effects" in settings else settings
        names = ("normal_length", "tangential_length", "work_of_separation", "work_ratio")
        return cls(**{name: law.get(name, np.nan) for name in names})

    @property
    def tangential_work(self) -> float:
        """Tangential work of separation φt, N/m."""
        return self.work_of_separation * self.work_ratio


def body_settings(data: xr.Dataset, side: str = "body") -> dict[str, Any]:
    """Return the settings of the body, or of the counter body, of a study."""
    return dict(dataset.settings_of(data)[side])


def radius(data: xr.Dataset) -> float:
    """Return the radius of the cylinder of a study, nm."""
    return float(dataset.settings_of(data)["surface"]["radius"])


def reduced_line_load(load: Array, data: xr.Dataset) -> Array:
    """Return line loads (N/m) over πRφ0 for bodies 1 µm thick (Eq. 4.3)."""
    return load * THICKNESS / (np.pi * radius(data) * WORK_UNIT)


def plane_strain_modulus(data: xr.Dataset, poisson_ratio: float) -> float:
    """Return E/(1-ν²) of the body of a study that varies Poisson's ratio, GPa."""
    return float(body_settings(data)["youngs_modulus"] / (1 - poisson_ratio**2))


def reduced_work(data: xr.Dataset, work: float) -> float:
    """Return a work of separation (N/m) over δn E, φn* of Chapter 5."""
    return work / (LawScales.of(data).normal_length * body_settings(data)["youngs_modulus"])


def critical_modulus_ratio(data: xr.Dataset) -> float:
    """Return E/τ_max above which a flat layer slides without stick-slip.

    The layer is then stiffer than the steepest fall of the force of a lattice of springs (Section 6.3).
    """
    law, body = LawScales.of(data), body_settings(data, "counter_body")
    work, length = law.tangential_work, law.tangential_length
    strength = adhesion.tangential_strength(work, length, 0.0)
    fall = springs.steepest_fall(lattice_constant(data), length) * work / length**2
    return float(2 * (1 + body["poisson_ratio"]) * body["thickness"] * fall / strength)


def lattice_constant(data: xr.Dataset) -> float:
    """Return the lattice constant of the sites that springs join, nm."""
    return float(dataset.settings_of(data)["pairing"]["lattice_constant"])
