"""Means over members at equal pressure, and along paths of which some end before others."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from contactsim.analysis.aggregate import ensemble_means
from contactsim.analysis.rough_paths import EQUAL_PRESSURES, at_equal_pressure

SHARE = np.linspace(0.0, 1.0, 41)


def two_paths() -> xr.Dataset:
    """Two members whose load falls first, then rises: one has twice the area of the other at equal pressure."""
    pressure = np.where(SHARE < 0.25, -0.04 * SHARE, -0.01 + 0.04 * (SHARE - 0.25))
    area = np.array([SHARE, 2 * SHARE]) / 4
    columns = {"normalised_pressure": np.array([pressure, pressure]), "relative_interacting_area": area}
    columns |= {"rms_gradient_interacting": np.full((2, 41), 0.5), "status": np.zeros((2, 41))}
    return xr.Dataset({name: (("member", "step"), values) for name, values in columns.items()}, {"member": [0, 1]})


@pytest.mark.parametrize(("reduced", "scale"), [(False, 1.0), (True, 2.0)])
def test_areas_at_equal_pressure_are_those_of_the_rising_branch(reduced, scale):
    means = at_equal_pressure(two_paths(), reduced, "relative_interacting_area", 0.015)
    assert means.pressure.size == EQUAL_PRESSURES
    assert means.pressure[[0, -1]] == pytest.approx([-0.01 + 0.025 / EQUAL_PRESSURES, 0.015])
    share = 0.25 + (means.pressure + 0.01) / 0.04
    assert means.area == pytest.approx(1.5 * share / 4)
    assert means.area_error == pytest.approx(0.5 * share / 4)
    assert means.abscissa == pytest.approx(scale * means.pressure)
    assert means.abscissa_error == pytest.approx(0.0, abs=1e-15)


def test_means_along_paths_end_with_the_shortest_path():
    data = two_paths()
    ended = data.where((data.member == 0) | (data.step < 30))
    means = ensemble_means(ended, ("relative_interacting_area",))
    known = np.isfinite(means.relative_interacting_area_mean.values)
    assert known.tolist() == [True] * 30 + [False] * 11
    assert means.relative_interacting_area_mean.values[29] == pytest.approx(1.5 * SHARE[29] / 4)
