"""A made path through a rough contact, whose readings are known by hand."""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.observables.contact_readings import CRITERIA

STEPS = np.arange(0.0, 31.0)
LENGTH, MODULUS = 1000.0, 2.0


def rough_path(pressure: np.ndarray = 1e-4 * STEPS) -> xr.Dataset:
    """A path whose criteria differ by a factor: its lengths are those of half the period at the end, by place."""
    lengths = {length: LENGTH * STEPS / 60 * (place + 1) / 4 for place, (length, _) in enumerate(CRITERIA.values())}
    slopes = {slope: np.full(STEPS.size, 0.1) for _, slope in CRITERIA.values()}
    columns = {"approach": STEPS - 5.0, "normalised_pressure": pressure, "mean_gap": 40.0 - STEPS}
    columns |= {"conformity_long": STEPS / 40, "conformity_short": STEPS / 50}
    columns |= {"touching_peaks": 10 * STEPS, "status": np.zeros(STEPS.size), "relative_interacting_area": STEPS / 60}
    data = xr.Dataset({name: ("step", values) for name, values in (columns | lengths | slopes).items()})
    return data.assign(length=LENGTH, contact_modulus=MODULUS, approach_first_touch=-5.0, rms_gradient=0.2)
