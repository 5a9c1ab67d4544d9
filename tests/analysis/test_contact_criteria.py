"""Numbers by each criterion of contact, on made paths whose answers are known."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from contactsim.analysis.contact_criteria import CRITERIA, compare_criteria, criterion_numbers
from contactsim.observables.adhesion import INTERACTING

APPROACH = np.arange(0.0, 21.0)


def test_numbers_are_read_at_12_nm_and_at_an_area_of_0_02():
    numbers = criterion_numbers(APPROACH, 0.01 * APPROACH, 1e-3 * APPROACH, 0.5 + 0.1 * APPROACH)
    assert numbers[:3] == pytest.approx([0.12, 2e-3, 0.7])


def test_a_table_has_every_criterion_and_a_mean_needs_all_members():
    shape = ("member", "step")
    ones = np.ones((2, APPROACH.size))
    lengths = dict.fromkeys(CRITERIA.values(), (shape, 10.0 * ones * APPROACH))
    gradients = {name: (shape, np.minimum(0.6 + 0.04 * APPROACH, 1.0) * ones) for name in CRITERIA}
    lengths["contact_length"] = (shape, 10.0 * APPROACH * np.array([[1.0], [0.0]]))
    states = {"approach": ones * APPROACH, "normalised_pressure": ones, "status": 0 * ones.astype(int)}
    data = xr.Dataset(
        lengths | gradients | {name: (shape, values) for name, values in states.items()},
        {"member": [0, 1]},
    ).assign(approach_first_touch=0.0, length=1000.0, rms_gradient=1.0)
    table = compare_criteria(data.expand_dims(work_of_separation=[10.5])).set_index("criterion")
    assert set(table.index) == {"contact_length", *INTERACTING}
    assert table.area_at_12nm["contact_length"] == pytest.approx(0.06)
    assert table.area_at_12nm["interacting_length_0_1"] == pytest.approx(0.12)
    assert np.isnan(table.pressure_at_area_0_02["contact_length"])  # one member never touches
